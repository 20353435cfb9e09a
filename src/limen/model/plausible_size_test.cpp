// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/model/plausible_size.h"

#include <string>

#include <gtest/gtest.h>

#include "limen/base/error.h"

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
std::string refusal_of(const Thing& thing) {
  try {
    require_plausible_size(thing);
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

}  // namespace
}  // namespace limen
