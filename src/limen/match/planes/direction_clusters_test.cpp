// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/match/planes/direction_clusters.h"

#include <cmath>

#include <gtest/gtest.h>

#include "limen/base/random.h"
#include "limen/geometry/random_vectors.h"

namespace limen {
namespace {

struct Planes {
  std::vector<Plane> planes;
  std::vector<double> weights;
  void add(const Vector3d& normal, double weight) {
    planes.push_back({normal.normalized(), 0.0});
    weights.push_back(weight);
  }
};

Vector3d yawed(double angle_degrees) {
  return {std::cos(radians(angle_degrees)), std::sin(radians(angle_degrees)), 0.0};
}

double line_angle_degrees(const Vector3d& a, const Vector3d& b) {
  return degrees(std::atan2(a.cross(b).norm(), std::abs(a.dot(b))));
}

DirectionClusterOptions fine_options() {
  DirectionClusterOptions options;
  options.max_angle_rad = radians(10.0);
  options.max_clusters = 0;
  return options;
}

TEST(DirectionClusters, OfARoomAreItsThreeAxesWhicheverWayNormalsPoint) {
  RandomStream random(1);
  Planes room;
  for (int i = 0; i < 30; ++i) {
    const Vector3d axis = Vector3d::Unit(i % 3);
    const Vector3d noise = 0.01 * normal_vector(random);
    room.add((random.below(2) == 0 ? 1.0 : -1.0) * (axis + noise), random.uniform(10.0, 1000.0));
  }
  const auto found = cluster_directions(room.planes, room.weights, Vector3d::UnitZ());
  ASSERT_EQ(found.clusters.size(), 3U);
  EXPECT_EQ(found.independent, 3);
  ASSERT_GE(found.horizontal, 0);
  EXPECT_LT(line_angle_degrees(found.clusters[static_cast<std::size_t>(found.horizontal)].direction,
                               Vector3d::UnitZ()),
            1.0);
  for (const DirectionCluster& cluster : found.clusters) {
    EXPECT_EQ(cluster.planes.size(), 10U);
    const int axis = cluster.planes.front() % 3;
    EXPECT_LT(line_angle_degrees(cluster.direction, Vector3d::Unit(axis)), 0.6);
    for (const int plane : cluster.planes) EXPECT_EQ(plane % 3, axis);
  }
  EXPECT_EQ(cluster_directions(room.planes, room.weights, std::nullopt).horizontal, -1);
}

TEST(DirectionClusters, SmallToleranceTellsAnObliqueWingApart) {
  Planes museum;
  museum.add(Vector3d::UnitZ(), 500);
  for (const double yaw : {0.0, 90.0, 30.0, 120.0, 181.0, 299.0}) museum.add(yawed(yaw), 100 - 0.1 * yaw);
  const auto fine = cluster_directions(museum.planes, museum.weights, Vector3d::UnitZ(), fine_options());
  ASSERT_EQ(fine.clusters.size(), 5U);
  EXPECT_EQ(fine.horizontal, 0);
  // The published tolerance sees three: the wing falls to the nearest of them.
  const auto coarse = cluster_directions(museum.planes, museum.weights, Vector3d::UnitZ());
  EXPECT_EQ(coarse.clusters.size(), 3U);
}

TEST(DirectionClusters, DirectionIsTheWeightedMainEigenvector) {
  Planes walls;
  walls.add(yawed(0.0), 300);
  walls.add(-yawed(4.0), 100);
  const auto found = cluster_directions(walls.planes, walls.weights, std::nullopt, fine_options());
  ASSERT_EQ(found.clusters.size(), 1U);
  // Of two lines at 4 degrees with weights 3 : 1.
  const double expected = 0.5 * degrees(std::atan2(std::sin(radians(8.0)), 3.0 + std::cos(radians(8.0))));
  EXPECT_NEAR(line_angle_degrees(found.clusters[0].direction, yawed(0.0)), expected, 1e-9);
  EXPECT_GT(found.clusters[0].direction.x(), 0.9);
}

TEST(DirectionClusters, CountTheIndependentOnes) {
  Planes corridor;
  corridor.add(Vector3d::UnitZ(), 100);
  corridor.add(Vector3d::UnitY(), 90);
  corridor.add(-Vector3d::UnitY(), 80);
  auto found = cluster_directions(corridor.planes, corridor.weights, Vector3d::UnitZ());
  EXPECT_EQ(found.independent, 2);
  // Three directions in one plane are still two.
  Planes fan;
  for (const double yaw : {0.0, 60.0, 120.0}) fan.add(yawed(yaw), 10);
  found = cluster_directions(fan.planes, fan.weights, Vector3d::UnitZ());
  EXPECT_EQ(found.clusters.size(), 3U);
  EXPECT_EQ(found.independent, 2);
  EXPECT_EQ(found.horizontal, -1);
  found = cluster_directions({}, {}, std::nullopt);
  EXPECT_EQ(found.independent, 0);
}

TEST(DirectionClusters, KeepAPlaneOutThatFitsNoDirection) {
  Planes planes;
  planes.add(Vector3d::UnitX(), 100);
  planes.add(Vector3d::UnitY(), 90);
  planes.add(Vector3d::UnitZ(), 80);
  planes.add(Vector3d(1.0, 1.0, 1.0), 10);
  const auto found = cluster_directions(planes.planes, planes.weights, std::nullopt);
  ASSERT_EQ(found.clusters.size(), 3U);
  for (const DirectionCluster& cluster : found.clusters) EXPECT_EQ(cluster.planes.size(), 1U);
}

}  // namespace
}  // namespace limen
