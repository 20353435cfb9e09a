// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/bim/read_bim.h"

#include <string>

#include "support/test_support.h"
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "limen/base/error.h"

namespace limen {
namespace {

using testing_io::TemporaryFolder;

/// A box of 4 x 3 x 2 m as six quadrilaterals, outwards.
const std::string kBoxVertices = "v 0 0 0\nv 4 0 0\nv 4 3 0\nv 0 3 0\nv 0 0 2\nv 4 0 2\nv 4 3 2\nv 0 3 2\n";
const std::string kBoxFaces = "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

BimModel model_of(const std::string& file, const std::string& text) {
  const TemporaryFolder folder;
  return read_bim(folder.write(file, text));
}

double total_area(const BimModel& model) {
  double sum = 0.0;
  for (const BimFace& face : model.faces) sum += face.area_m2;
  return sum;
}

/// True where every face looks away from the middle of the box.
bool outwards(const BimModel& model, const Vector3d& middle) {
  return std::all_of(model.faces.begin(), model.faces.end(),
                     [&](const BimFace& face) { return face.plane.signed_distance(middle) < 0.0; });
}

TEST(ReadObj, BoxOfQuadrilaterals) {
  const BimModel model = model_of("box.obj", "# a box\n" + kBoxVertices + kBoxFaces);
  EXPECT_EQ(model.schema, "OBJ");
  ASSERT_EQ(model.elements.size(), 1U);
  EXPECT_EQ(model.elements[0].type, "mesh");
  ASSERT_EQ(model.faces.size(), 6U);
  EXPECT_NEAR(total_area(model), 2 * (12.0 + 8.0 + 6.0), 1e-6);
  EXPECT_TRUE(outwards(model, {2.0, 1.5, 1.0}));
  EXPECT_TRUE(model.warnings.empty());
}

TEST(ReadObj, TrianglesInsideOutBecomeSixFacesOutwards) {
  std::string faces;
  for (const char* quad : {"4 3 2 1", "5 6 7 8", "1 2 6 5", "2 3 7 6", "3 4 8 7", "4 1 5 8"}) {
    const std::string q(quad);
    faces += fmt::format("f {2} {1} {0}\nf {3} {2} {0}\n", q[0], q[2], q[4], q[6]);
  }
  const BimModel model = model_of("box.obj", kBoxVertices + faces);
  ASSERT_EQ(model.faces.size(), 6U);
  EXPECT_TRUE(outwards(model, {2.0, 1.5, 1.0}));
}

TEST(ReadObj, OneTurnedFaceIsTurnedBack) {
  const std::string faces = "f 1 2 3 4\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
  EXPECT_TRUE(outwards(model_of("box.obj", kBoxVertices + faces), {2.0, 1.5, 1.0}));
}

TEST(ReadObj, NegativeIndicesGroupsAndDoubledFaces) {
  const std::string second = "v 9 0 0\nv 10 0 0\nv 10 1 0\n";
  const BimModel model =
      model_of("two.obj", "o IfcWall-7\n" + kBoxVertices + kBoxFaces + "f 4 3 2 1\n" + second +
                              "g IfcSlab floor\nf -3//1 -2//1 \\\n -1//1\nf -3 -2 -1\n");
  ASSERT_EQ(model.elements.size(), 2U);
  EXPECT_EQ(model.elements[0].name, "IfcWall-7");
  EXPECT_EQ(model.elements[0].kind, BimKind::wall);
  EXPECT_EQ(model.elements[1].kind, BimKind::slab);  // the group's name goes before the object's
  ASSERT_EQ(model.faces.size(), 7U);
  EXPECT_EQ(model.faces.back().element, 1);
  EXPECT_NEAR(model.faces.back().area_m2, 0.5, 1e-9);
}

TEST(ReadObj, HoleOverABridgeAndCornersOnEdges) {
  // A square of 4 m with a hole of 2 m, one polygon; beside it a strip of triangles with a T-junction.
  const BimModel model = model_of(
      "hole.obj",
      "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 1 1 0\nv 1 3 0\nv 3 3 0\nv 3 1 0\nv 6 0 0\nv 6 4 0\nv 4 2 0\n"
      "f 1 2 3 4 1 5 6 7 8 5\nf 2 9 11\nf 9 10 11\nf 10 3 11\n");
  ASSERT_EQ(model.faces.size(), 1U);
  EXPECT_EQ(model.faces[0].outline.outer.size(), 4U);
  ASSERT_EQ(model.faces[0].outline.holes.size(), 1U);
  EXPECT_NEAR(model.faces[0].area_m2, 24.0 - 4.0, 1e-6);
}

TEST(ReadObj, FarCoordinatesKeepTheirMillimetres) {
  const BimModel model = model_of(
      "far.obj", "v 1051200.001 6841900 40\nv 1051204.001 6841900 40\nv 1051204.001 6841903 40\nf 1 2 3\n");
  EXPECT_GT(model.local_origin.norm(), 1e6);
  const BimFace& face = model.faces.at(0);
  double low_x = 1e300;
  for (const Vector2d& p : face.outline.outer)
    low_x = std::min(low_x, model.local_origin.x() + face.frame.to_space(p).x());
  EXPECT_NEAR(low_x, 1051200.001, 2e-5);
  EXPECT_NEAR(face.area_m2, 6.0, 1e-4);
}

TEST(ReadObj, AModelOfAnotherUnitIsQuestioned) {
  const BimModel model = model_of("mm.obj", "v 0 0 0\nv 8000 0 0\nv 8000 6000 0\nf 1 2 3\n");
  ASSERT_EQ(model.warnings.size(), 1U);
  EXPECT_NE(model.warnings[0].find("unit"), std::string::npos);
}

TEST(ReadObj, DamageIsNamedWithItsLine) {
  for (const char* bad :
       {"v 0 0\nf 1 1 1\n", "v 0 0 0\nv 1 0 0\nf 1 2 3\n", "v 0 0 0\nf 1 x 1\n", "v 0 0 0\nf 0 0 0\n"}) {
    try {
      model_of("bad.obj", bad);
      ADD_FAILURE() << "no error for " << bad;
    } catch (const Error& error) {
      EXPECT_EQ(error.fault(), Fault::input);
      EXPECT_NE(error.where().find("line"), std::string::npos) << bad;
    }
  }
  EXPECT_THROW(model_of("empty.obj", kBoxVertices), Error);
  EXPECT_THROW(model_of("words.txt", "this is no model\n"), Error);
}

TEST(ReadMeshPly, AsciiAndBothBinaryOrders) {
  using testing_io::Writing;
  for (const Writing writing : {Writing::ascii, Writing::little, Writing::big}) {
    std::string text = testing_io::format_line(writing) +
                       "comment offset 1000 2000 0\nelement vertex 4\nproperty float x\nproperty double y\n"
                       "property float z\nelement face 2\nproperty uchar flag\n"
                       "property list uchar int vertex_indices\nend_header\n";
    const double points[4][3] = {{0, 0, 1}, {4, 0, 1}, {4, 3, 1}, {0, 3, 1}};
    for (const auto& p : points)
      text += testing_io::number(static_cast<float>(p[0]), writing) + testing_io::number(p[1], writing) +
              testing_io::number(static_cast<float>(p[2]), writing) + testing_io::row_end(writing);
    const int triangles[2][3] = {{0, 1, 2}, {0, 2, 3}};
    for (const auto& t : triangles) {
      text += testing_io::number<std::uint8_t>(7, writing) + testing_io::number<std::uint8_t>(3, writing);
      for (const int corner : t) text += testing_io::number(corner, writing);
      text += testing_io::row_end(writing);
    }
    const BimModel model = model_of("square.ply", text);
    ASSERT_EQ(model.faces.size(), 1U);
    EXPECT_NEAR(model.faces[0].area_m2, 12.0, 1e-6);
    EXPECT_NEAR(model.faces[0].plane.normal.z(), 1.0, 1e-12);
    EXPECT_NEAR((model.local_origin + model.faces[0].frame.origin).y(), 2000.0, 3.001);
    EXPECT_THROW(model_of("cut.ply", text.substr(0, text.size() - 6)), Error);
  }
}

TEST(ReadBim, ContentDecidesWhatAModelIs) {
  const TemporaryFolder folder;
  EXPECT_TRUE(is_bim_file(folder.write("a.txt", kBoxVertices + kBoxFaces)));
  EXPECT_FALSE(is_bim_file(folder.write("b.obj", "1 2 3\n4 5 6\n")));
  EXPECT_FALSE(is_bim_file(folder.write(
      "c.ply", testing_io::simple_ply<float>({{0, 0, 0}, {1, 1, 1}}, testing_io::Writing::little))));
  EXPECT_FALSE(is_bim_file(folder / "missing.ifc"));
}

}  // namespace
}  // namespace limen
