// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/bim/solid/solid_faces.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "limen/bim/solid/solid.h"
#include "limen/geometry/polygon_clip.h"

namespace limen {
namespace {

/// A box between two corners, normals outwards.
Solid box(const Vector3d& low, const Vector3d& high) {
  Solid solid;
  for (int k = 0; k < 8; ++k)
    solid.mesh.points.emplace_back((k & 1) != 0 ? high.x() : low.x(), (k & 2) != 0 ? high.y() : low.y(),
                                   (k & 4) != 0 ? high.z() : low.z());
  for (const auto& quad : {std::vector<std::uint32_t>{0, 2, 3, 1},
                           {4, 5, 7, 6},
                           {0, 1, 5, 4},
                           {2, 6, 7, 3},
                           {0, 4, 6, 2},
                           {1, 3, 7, 5}})
    solid.mesh.add(quad);
  return solid;
}

/// An upright prism of `corners` sides about the origin.
Solid prism(int corners, double radius_m, double low_m, double high_m) {
  Solid solid;
  std::vector<std::uint32_t> bottom;
  std::vector<std::uint32_t> top;
  const auto size = static_cast<std::uint32_t>(corners);
  for (std::uint32_t k = 0; k < size; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / size;
    solid.mesh.points.emplace_back(radius_m * std::cos(angle), radius_m * std::sin(angle), low_m);
    solid.mesh.points.emplace_back(radius_m * std::cos(angle), radius_m * std::sin(angle), high_m);
    bottom.push_back(2 * (size - 1 - k));
    top.push_back(2 * k + 1);
    const std::uint32_t next = (k + 1) % size;
    solid.mesh.add({2 * k, 2 * next, 2 * next + 1, 2 * k + 1});
  }
  solid.mesh.add(bottom);
  solid.mesh.add(top);
  return solid;
}

Solid operation(SolidOperation kind, std::vector<Solid> children) {
  Solid solid;
  solid.operation = kind;
  solid.children = std::move(children);
  return solid;
}

double total(const std::vector<BimFace>& faces) {
  double sum = 0.0;
  for (const BimFace& face : faces) sum += face.area_m2;
  return sum;
}

/// The volume that flat faces enclose (divergence theorem).
double volume(const std::vector<BimFace>& faces) {
  double sum = 0.0;
  for (const BimFace& face : faces) sum += face.plane.offset * face.area_m2 / 3.0;
  return sum;
}

TEST(SolidSection, BoxAndItsOwnFaces) {
  const Solid solid = box({0, 0, 0}, {4, 3, 2});
  const auto area_at = [&](double z, PlaneSide side) {
    return area(section(solid.mesh, {{0, 0, z}, Vector3d::UnitX(), Vector3d::UnitY()}, side));
  };
  EXPECT_NEAR(area_at(1.0, PlaneSide::before), 12.0, 1e-6);
  EXPECT_NEAR(area_at(2.0, PlaneSide::behind), 12.0, 1e-6);
  EXPECT_EQ(area_at(2.0, PlaneSide::before), 0.0);
  EXPECT_NEAR(area_at(0.0, PlaneSide::before), 12.0, 1e-6);
  EXPECT_EQ(area_at(0.0, PlaneSide::behind), 0.0);
  EXPECT_EQ(area_at(5.0, PlaneSide::behind), 0.0);
}

TEST(SolidFaces, AWindowThroughAWall) {
  const Solid wall = box({0, 0, 0}, {4, 0.3, 2.5});
  for (const double beyond : {0.0, 0.1}) {
    const Solid hole = box({1, -beyond, 1}, {2, 0.3 + beyond, 2});
    const SolidFaces made = solid_faces({wall}, {&hole});
    EXPECT_EQ(made.faces.size(), 10U);
    EXPECT_NEAR(volume(made.faces), 4 * 0.3 * 2.5 - 0.3, 1e-6) << beyond;
    EXPECT_NEAR(total(made.faces), 2 * (10.0 - 1.0) + 2 * (0.75 + 1.2) + 4 * 0.3, 1e-6) << beyond;
  }
}

TEST(SolidFaces, ANicheAndAnOpeningThatOnlyTouches) {
  const Solid wall = box({0, 0, 0}, {4, 0.3, 2.5});
  const Solid niche = box({1, 0.2, 1}, {2, 0.3, 2});
  EXPECT_NEAR(volume(solid_faces({wall}, {&niche}).faces), 3.0 - 0.1, 1e-6);
  const Solid outside = box({1, 0.3, 1}, {2, 0.5, 2});
  EXPECT_EQ(solid_faces({wall}, {&outside}).faces.size(), 6U);
}

TEST(SolidFaces, TwoOpeningsThatOverlapAndTwoThatAbut) {
  const Solid wall = box({0, 0, 0}, {6, 0.3, 2.5});
  const Solid one = box({1, -0.1, 1}, {2, 0.4, 2});
  const Solid over = box({1.5, -0.1, 1.5}, {2.5, 0.4, 2.2});
  EXPECT_NEAR(volume(solid_faces({wall}, {&one, &over}).faces), 0.3 * (15.0 - 1.0 - 0.7 + 0.25), 1e-6);
  const Solid beside = box({2, 0.0, 1}, {3, 0.3, 2});
  const SolidFaces made = solid_faces({wall}, {&one, &beside});
  EXPECT_NEAR(volume(made.faces), 0.3 * (15.0 - 2.0), 1e-6);
  EXPECT_EQ(made.faces.size(), 10U);
}

TEST(SolidFaces, AnOpeningDownToTheFloorSplitsItsUnderside) {
  const Solid wall = box({0, 0, 0}, {4, 0.3, 2.5});
  const Solid door = box({1, 0, 0}, {2, 0.3, 2});
  const SolidFaces made = solid_faces({wall}, {&door});
  EXPECT_NEAR(volume(made.faces), 3.0 - 0.6, 1e-6);
  // Two undersides, the door's sides and lintel.
  EXPECT_EQ(made.faces.size(), 10U);
}

TEST(SolidFaces, ARoundHoleInASlab) {
  const Solid slab = box({-2, -2, 0}, {2, 2, 0.2});
  const Solid hole = prism(24, 0.5, -1.0, 1.0);
  const double circle = 12.0 * 0.25 * std::sin(std::numbers::pi / 12.0);
  const SolidFaces made = solid_faces({slab}, {&hole});
  EXPECT_EQ(made.faces.size(), 6U + 24U);
  EXPECT_NEAR(volume(made.faces), 0.2 * (16.0 - circle), 1e-5);
}

TEST(SolidFaces, ChainsOfOperations) {
  const Solid a = box({0, 0, 0}, {2, 2, 2});
  const Solid b = box({1, 1, 1}, {3, 3, 3});
  EXPECT_NEAR(volume(solid_faces({operation(SolidOperation::unite, {a, b})}).faces), 15.0, 1e-5);
  EXPECT_NEAR(volume(solid_faces({operation(SolidOperation::intersect, {a, b})}).faces), 1.0, 1e-5);
  EXPECT_NEAR(volume(solid_faces({operation(SolidOperation::subtract, {a, b})}).faces), 7.0, 1e-5);
  // a less the part of b below z = 1.5.
  const Solid below = box({-5, -5, -5}, {5, 5, 1.5});
  const Solid part = operation(SolidOperation::intersect, {b, below});
  EXPECT_NEAR(volume(solid_faces({operation(SolidOperation::subtract, {a, part})}).faces), 7.5, 1e-5);
  // Equal solids: nothing is left, and uniting them changes nothing.
  EXPECT_TRUE(solid_faces({operation(SolidOperation::subtract, {a, a})}).faces.empty());
  EXPECT_NEAR(total(solid_faces({operation(SolidOperation::unite, {a, a})}).faces), 24.0, 1e-6);
}

TEST(SolidFaces, ASlopingCut) {
  const Solid wall = box({0, 0, 0}, {4, 0.3, 3});
  Solid roof = box({-10, -10, 0}, {10, 10, 20});
  // Turned by 30 degrees about y, through (0, 0, 2).
  const Matrix3d turn = rotation_exp(Vector3d(0, -std::numbers::pi / 6.0, 0));
  for (Vector3d& point : roof.mesh.points) point = turn * point + Vector3d(0, 0, 2);
  const SolidFaces made = solid_faces({wall}, {&roof});
  const double rise = std::tan(std::numbers::pi / 6.0);
  const double reach = 1.0 / rise;  // where the roof is as high as the wall
  EXPECT_NEAR(volume(made.faces), 0.3 * (4.0 * 3.0 - 0.5 * reach), 1e-4);
}

TEST(SolidFaces, AnOpenSurfaceIsCutWithoutSides) {
  Solid sheet;
  sheet.mesh.points = {{0, 0, 0}, {4, 0, 0}, {4, 0, 2.5}, {0, 0, 2.5}};
  sheet.mesh.add({0, 1, 2, 3});
  const Solid hole = box({1, -0.1, 1}, {2, 0.4, 2});
  const SolidFaces made = solid_faces({sheet}, {&hole});
  ASSERT_EQ(made.faces.size(), 1U);
  EXPECT_NEAR(made.faces[0].area_m2, 9.0, 1e-6);
  EXPECT_EQ(made.open_cutters, 1U);
}

TEST(SolidFaces, FacesOfSeveralShapesAreJoined) {
  const Solid left = box({0, 0, 0}, {2, 0.3, 2.5});
  const Solid right = box({2, 0, 0}, {4, 0.3, 2.5});
  const Solid hole = box({1.5, -0.1, 1}, {2.5, 0.4, 2});
  std::size_t fronts = 0;
  for (const BimFace& face : solid_faces({left, right}, {&hole}).faces)
    fronts += face.plane.normal.y() < -0.99 ? 1 : 0;
  EXPECT_EQ(fronts, 1U);
}

}  // namespace
}  // namespace limen
