// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/match/planes/enumerate_rotations.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "limen/base/angles.h"

namespace limen {
namespace {

std::vector<AxisDirection> manhattan() {
  return {{Vector3d::UnitZ(), 30.0}, {Vector3d::UnitX(), 20.0}, {Vector3d::UnitY(), 10.0}};
}

std::vector<AxisDirection> turned(const std::vector<AxisDirection>& axes, const Matrix3d& rotation) {
  std::vector<AxisDirection> result = axes;
  for (AxisDirection& axis : result) axis.direction = rotation * axis.direction;
  return result;
}

bool holds(const std::vector<Matrix3d>& rotations, const Matrix3d& wanted) {
  return std::any_of(rotations.begin(), rotations.end(), [&](const Matrix3d& r) {
    return rotation_angle(r.transpose() * wanted) < radians(0.01);
  });
}

TEST(EnumerateRotations, ThreeOrthogonalDirectionsHaveTwentyFour) {
  RotationOptions options;
  options.gravity_known = false;
  const Matrix3d truth = rotation_exp({0.3, -0.8, 1.9});
  const std::vector<Matrix3d> rotations =
      enumerate_rotations(manhattan(), turned(manhattan(), truth), options);
  EXPECT_EQ(rotations.size(), 24U);
  EXPECT_TRUE(holds(rotations, truth));
  for (const Matrix3d& r : rotations) {
    EXPECT_LT((r * r.transpose() - Matrix3d::Identity()).norm(), 1e-12);
    EXPECT_GT(r.determinant(), 0.0);
  }
}

TEST(EnumerateRotations, KnownGravityLeavesFourHeadings) {
  const Matrix3d truth = rotation_exp({0, 0, 0.7});
  const std::vector<Matrix3d> rotations = enumerate_rotations(manhattan(), turned(manhattan(), truth), {});
  EXPECT_EQ(rotations.size(), 4U);
  EXPECT_TRUE(holds(rotations, truth));
}

TEST(EnumerateRotations, ObliqueWingGivesMoreHeadings) {
  std::vector<AxisDirection> axes = manhattan();
  axes.push_back({rotation_exp({0, 0, radians(30)}) * Vector3d::UnitX(), 8.0});
  const Matrix3d truth = rotation_exp({0, 0, -2.0});
  const std::vector<Matrix3d> rotations = enumerate_rotations(axes, turned(axes, truth), {});
  EXPECT_GT(rotations.size(), 4U);
  EXPECT_TRUE(holds(rotations, truth));
}

TEST(EnumerateRotations, OneWallAndKnownGravitySuffice) {
  const std::vector<AxisDirection> wall{{Vector3d::UnitX(), 5.0}};
  const Matrix3d truth = rotation_exp({0, 0, 1.1});
  const std::vector<Matrix3d> rotations = enumerate_rotations(wall, turned(wall, truth), {});
  EXPECT_EQ(rotations.size(), 2U);
  EXPECT_TRUE(holds(rotations, truth));
}

TEST(EnumerateRotations, NothingToTurnBy) {
  EXPECT_TRUE(enumerate_rotations({}, manhattan(), {.gravity_known = false}).empty());
  EXPECT_TRUE(enumerate_rotations({{Vector3d::UnitX(), 1.0}}, manhattan(), {.gravity_known = false}).empty());
}

TEST(AxisDirections, ClustersBySlopeAndWeighsByArea) {
  Features features;
  const auto add = [&](const Vector3d& normal, double area_m2) {
    PlanarPolygon plane;
    plane.plane.normal = normal.normalized();
    plane.area_m2 = area_m2;
    features.planes.push_back(plane);
  };
  add({0, 0, 1}, 10);
  add({0, 0.01, -1}, 10);
  add({1, 0, 0}, 5);
  add({1, 0.3, 0}, 4);
  const std::vector<AxisDirection> axes = axis_directions(features, 5.0);
  ASSERT_EQ(axes.size(), 3U);
  EXPECT_DOUBLE_EQ(axes[0].weight, 20.0);
  EXPECT_NEAR(std::abs(axes[0].direction.y()), 0.005, 1e-4);
  EXPECT_DOUBLE_EQ(axes[1].weight, 5.0);
}

}  // namespace
}  // namespace limen
