// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/model/plausible_size.h"

#include <string>

#include <gtest/gtest.h>

#include "limen/base/error.h"
#include "limen/geometry/random_vectors.h"

namespace limen {
namespace {

/// A grid of points that fills a box.
Scan box_of_points(const Vector3d& sides) {
  constexpr int kSteps = 12;
  Scan scan;
  scan.name = "box";
  for (int k = 0; k < kSteps * kSteps * kSteps; ++k) {
    const Vector3d step(k % kSteps, k / kSteps % kSteps, k / kSteps / kSteps);
    scan.points.emplace_back((step / (kSteps - 1)).cwiseProduct(sides));
  }
  return scan;
}

/// A square of `side` by `side` metres.
BimModel square(double side) {
  BimFace face;
  face.outline.outer = {{0, 0}, {side, 0}, {side, side}, {0, side}};
  face.area_m2 = side * side;
  BimModel model;
  model.faces = {face};
  return model;
}

template <typename Thing>
std::string refusal_of(const Thing& thing, const std::string& units_option = {}) {
  try {
    require_plausible_size(thing, units_option);
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::input);
    return error.what();
  }
  return {};
}

TEST(PlausibleSize, RoomsStreetsAndSurveysPass) {
  EXPECT_EQ(refusal_of(box_of_points({4.0, 3.0, 2.5})), "");
  EXPECT_EQ(refusal_of(box_of_points({8000.0, 3000.0, 150.0})), "");
  Scan far = box_of_points({12000.0, 40.0, 30.0});
  far.local_origin = {1051200.0, 6841900.0, 0.0};
  EXPECT_EQ(refusal_of(far), "");
  EXPECT_EQ(refusal_of(Scan{}), "");
}

TEST(PlausibleSize, OddSizesAreAskedAbout) {
  EXPECT_EQ(size_hint(box_of_points({40.0, 30.0, 9.0})), "");
  EXPECT_EQ(size_hint(box_of_points({8000.0, 3000.0, 150.0})), "") << "a street in the hills";
  EXPECT_NE(size_hint(box_of_points({315.0, 240.0, 118.0})).find("numbers in?"), std::string::npos);
  EXPECT_NE(size_hint(box_of_points({800.0, 600.0, 290.0})).find("numbers cm?"), std::string::npos);
  EXPECT_NE(size_hint(box_of_points({8000.0, 6000.0, 2900.0})).find("numbers mm?"), std::string::npos);
  EXPECT_TRUE(has_plausible_size(box_of_points({315.0, 240.0, 118.0})));
  EXPECT_FALSE(has_plausible_size(box_of_points({8000.0, 6000.0, 2900.0})));
  EXPECT_EQ(size_hint(Scan{}), "");
}

TEST(PlausibleSize, AdviceNamesTheOptionOfTheCommandOrNone) {
  const Scan inches = box_of_points({315.0, 240.0, 118.0});
  EXPECT_NE(size_hint(inches, "--source-units").find("give --source-units in"), std::string::npos);
  EXPECT_EQ(size_hint(inches).find("--"), std::string::npos);
  EXPECT_EQ(refusal_of(box_of_points({4000.0, 3000.0, 2500.0})).find("--"), std::string::npos);
}

TEST(PlausibleSize, DegreesAreNoMetres) {
  Scan degrees = box_of_points({0.0004, 0.0003, 9.0});
  for (Vector3d& point : degrees.points) point += Vector3d(7.75, 48.58, 140.0);
  EXPECT_NE(degrees_hint(degrees).find("longitude"), std::string::npos);
  EXPECT_NE(refusal_of(degrees).find("degrees"), std::string::npos);
  EXPECT_FALSE(has_plausible_size(degrees));
  EXPECT_EQ(degrees_hint(box_of_points({4.0, 3.0, 2.5})), "");
  EXPECT_EQ(degrees_hint(box_of_points({0.3, 0.3, 3.0})), "") << "a pillar";
}

TEST(PlausibleSize, APoseNeedsPoints) {
  Scan few = box_of_points({4.0, 3.0, 2.5});
  EXPECT_EQ(few_points_hint(few), "");
  few.points.resize(10);
  EXPECT_NE(few_points_hint(few).find("holds 10 points"), std::string::npos);
}

TEST(PlausibleSize, YUpIsSaidOfScansToo) {
  EXPECT_NE(up_hint({0.05, 0.99, -0.05}).find("y axis"), std::string::npos);
  EXPECT_EQ(up_hint({0.0, 0.05, 0.99}), "");
}

/// The six sides of a hall of 20 x 3 x 12 m, height along y or z.
BimModel hall(bool y_up) {
  BimModel model;
  model.schema = "OBJ";
  const auto add = [&](const Vector3d& normal, const Vector3d& at, double width, double height) {
    BimFace face;
    face.plane = {normal, normal.dot(at)};
    face.frame = make_frame(face.plane, at);
    const double w = 0.5 * width;
    const double h = 0.5 * height;
    face.outline.outer = {{-w, -h}, {w, -h}, {w, h}, {-w, h}};
    face.area_m2 = width * height;
    model.faces.push_back(face);
  };
  const Vector3d up = y_up ? Vector3d::UnitY() : Vector3d::UnitZ();
  const Vector3d across = y_up ? Vector3d::UnitZ() : Vector3d::UnitY();
  add(up, Vector3d::Zero(), 20, 12);
  add(up, 3.0 * up, 20, 12);
  add(across, 1.5 * up, 3, 3);
  add(Vector3d::UnitX(), 1.5 * up, 3, 3);
  return model;
}

TEST(PlausibleSize, AMeshWithYUpIsNoticed) {
  EXPECT_NE(axes_hint(hall(true)).find("y axis"), std::string::npos);
  EXPECT_EQ(axes_hint(hall(false)), "");
  BimModel ifc = hall(true);
  ifc.schema = "IFC4";
  EXPECT_EQ(axes_hint(ifc), "") << "the file says where up is";
}

TEST(PlausibleSize, ARoomInMillimetresIsRefusedByName) {
  EXPECT_NE(refusal_of(box_of_points({4000.0, 3000.0, 2500.0})).find("millimetres?"), std::string::npos);
  EXPECT_NE(refusal_of(box_of_points({0.004, 0.003, 0.0025})).find("kilometres?"), std::string::npos);
}

TEST(PlausibleSize, AFewPointsFarAwayDoNotCount) {
  Scan scan = box_of_points({10.0, 8.0, 3.0});
  for (int k = 0; k < 10; ++k) scan.points.emplace_back(2e5, -3e5, 4e5);
  EXPECT_EQ(refusal_of(scan), "");
}

TEST(PlausibleSize, OfAModelItsSurfaceCounts) {
  EXPECT_EQ(refusal_of(square(1000.0)), "");
  EXPECT_NE(refusal_of(square(10000.0)).find("millimetres?"), std::string::npos);
  EXPECT_NE(refusal_of(square(0.01)).find("kilometres?"), std::string::npos);
}

TEST(PlausibleSize, OfAModelTheOutlinesOfItsFacesCount) {
  BimModel model = square(10.0);
  model.faces.front().outline.outer = {{0, 0}, {6e6, 0}, {6e6, 1e-3}};
  model.faces.front().area_m2 = 3e3;
  EXPECT_NE(refusal_of(model).find("outlines"), std::string::npos);
  model.faces.front().outline.outer = {{0, 0}, {4e6, 0}, {4e6, 1e-3}};
  EXPECT_EQ(refusal_of(model), "");
}

TEST(PlausibleSize, OnlyAMeshIsAskedForItsUnit) {
  BimModel model = square(10000.0);
  model.schema = "OBJ";
  EXPECT_NE(refusal_of(model, "--units").find("--units"), std::string::npos);
  model.schema = "IFC4";
  EXPECT_EQ(refusal_of(model, "--units").find("--units"), std::string::npos);
}

TEST(PlausibleSize, CoordinatesOfSinglePrecisionFarFromZeroAreNoticed) {
  RandomStream random(3, 1);
  Scan scan;
  scan.local_origin = Vector3d(652000.0, 6840000.0, 0.0);
  for (int k = 0; k < 200; ++k)
    scan.points.push_back(uniform_vector(Vector3d::Zero(), Vector3d(9.0, 7.0, 3.0), random));
  EXPECT_EQ(rounding_hint(scan), "");
  for (Vector3d& x : scan.points)
    x = (scan.local_origin + x).cast<float>().cast<double>() - scan.local_origin;
  EXPECT_NE(rounding_hint(scan).find("rounded to 0.5 m"), std::string::npos) << rounding_hint(scan);
  // Near 0 single precision is fine enough; centimetres are not.
  scan.local_origin.setZero();
  for (Vector3d& x : scan.points)
    x = uniform_vector(Vector3d::Zero(), Vector3d(9.0, 7.0, 3.0), random).cast<float>().cast<double>();
  EXPECT_EQ(coordinate_step_m(scan), 0.0);
  for (Vector3d& x : scan.points) x = 0.001 * (1000.0 * x).array().round();
  EXPECT_EQ(coordinate_step_m(scan), 0.0);
  for (Vector3d& x : scan.points) x = 0.01 * (100.0 * x).array().round();
  EXPECT_EQ(coordinate_step_m(scan), 0.01);
}

}  // namespace
}  // namespace limen
