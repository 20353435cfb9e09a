// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/match/planes/polygon_distance.h"

#include <cmath>

#include <gtest/gtest.h>

#include "limen/base/random.h"
#include "limen/geometry/random_vectors.h"
#include "limen/match/planes/threshold_matching.h"

namespace limen {
namespace {

/// A rectangle of a plane: [x0, x1] x [y0, y1] of the plane's frame near the origin.
PlanarPolygon rectangle(const Plane& plane, double x0, double y0, double x1, double y1) {
  PlanarPolygon polygon;
  polygon.plane = plane;
  polygon.frame = make_frame(plane, Vector3d::Zero());
  polygon.parts = {{{{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}, {}}};
  polygon.inliers = 100;
  polygon.area_m2 = area(polygon.parts);
  polygon.centroid = polygon.frame.to_space({0.5 * (x0 + x1), 0.5 * (y0 + y1)});
  return polygon;
}

Plane wall_at(double offset) {
  return {Vector3d::UnitX(), offset};
}

TEST(Bisector, IsHalfwayWhicheverWayTheNormalsPoint) {
  for (const double sign : {1.0, -1.0}) {
    const Plane b{sign * Vector3d::UnitX(), sign * 3.0};
    const Plane middle = bisector(wall_at(1.0), b);
    EXPECT_NEAR((middle.normal - Vector3d::UnitX()).norm(), 0.0, 1e-15);
    EXPECT_NEAR(middle.offset, 2.0, 1e-15);
  }
  // Points of a bisector are as far from one plane as from the other.
  RandomStream random(1);
  for (int trial = 0; trial < 50; ++trial) {
    const auto direction = [&] { return normal_vector(random).normalized(); };
    const Plane a{direction(), random.uniform(-3.0, 3.0)};
    const Plane b{direction(), random.uniform(-3.0, 3.0)};
    const Plane middle = bisector(a, b);
    const Vector3d x = middle.project(5.0 * direction());
    EXPECT_NEAR(std::abs(a.signed_distance(x)), std::abs(b.signed_distance(x)), 1e-12);
    EXPECT_GE(middle.normal.dot(a.normal), 0.7);
  }
}

TEST(BisectorDistance, OfParallelPlanesIsTheirGap) {
  const PlanarPolygon a = rectangle(wall_at(1.0), 0, 0, 2, 2);
  EXPECT_NEAR(bisector_distance(a, rectangle(wall_at(1.07), 1, 1, 5, 2)), 0.07, 1e-12);
  EXPECT_NEAR(bisector_distance(a, rectangle(wall_at(1.07).flipped(), 1, 1, 5, 2)), 0.07, 1e-12);
}

TEST(BisectorDistance, OfCrossingPlanesFollowsTheAngle) {
  // Planes through the z axis at 2 * theta, centroids at distance r from it.
  const double theta = 0.05;
  const double r = 4.0;
  PlanarPolygon a = rectangle(wall_at(0.0), -1, -1, 1, 1);
  PlanarPolygon b = a;
  const Rigid3 turn{rotation_exp(Vector3d(0.0, 0.0, 2.0 * theta)), Vector3d::Zero()};
  a.centroid = Vector3d(0.0, r, 0.0);
  b.plane = transformed(turn, b.plane);
  b.centroid = turn * a.centroid;
  EXPECT_NEAR(angle_between(a.plane, b.plane), 2.0 * theta, 1e-12);
  EXPECT_NEAR(bisector_distance(a, b), 2.0 * r * std::sin(theta), 1e-12);
}

TEST(Overlap, IsTheShareOfTheSmallerPolygon) {
  const PlanarPolygon big = rectangle(wall_at(0.0), 0, 0, 4, 2);
  const PlanarPolygon small = rectangle(wall_at(0.02), 3, 1, 5, 2);
  EXPECT_NEAR(overlap_area(big, small), 1.0, 1e-4);
  EXPECT_NEAR(overlap_ratio(big, small), 0.5, 1e-4);
  EXPECT_NEAR(overlap_ratio(small, big), 0.5, 1e-4);
  PlanarPolygon nothing = small;
  nothing.parts.clear();
  EXPECT_EQ(overlap_ratio(big, nothing), 0.0);
  EXPECT_EQ(overlap_ratio(nothing, nothing), 0.0);
}

TEST(Agreement, FollowsEquationTenForOnePartner) {
  const PlanarPolygon a = rectangle(wall_at(0.0), 0, 0, 4, 2);
  const std::vector<PlanarPolygon> scan{rectangle(wall_at(0.05), 0, 0, 2, 2)};
  EXPECT_NEAR(agreement(a, scan, 0.1), 4.0 * (1.0 - 0.25), 1e-3);
  EXPECT_EQ(agreement(a, scan, 0.05 - 1e-9), 0.0);
  EXPECT_EQ(agreement(a, {}, 0.1), 0.0);
}

TEST(Agreement, CountsAPlaceOnceForTheNearestPolygon) {
  const PlanarPolygon a = rectangle(wall_at(0.0), 0, 0, 4, 2);
  const PlanarPolygon exact = rectangle(wall_at(0.0), 0, 0, 4, 2);
  const PlanarPolygon half_off = rectangle(wall_at(0.05), 0, 0, 4, 2);
  EXPECT_NEAR(agreement(a, {half_off, exact, exact}, 0.1), 8.0, 1e-3);
  const PlanarPolygon part = rectangle(wall_at(0.0), 0, 0, 1, 2);
  EXPECT_NEAR(agreement(a, {half_off, part}, 0.1), 2.0 + 6.0 * 0.75, 1e-3);
}

TEST(Agreement, NeverExceedsTheAreaAndIsSymmetric) {
  RandomStream random(5);
  const auto random_scan = [&] {
    std::vector<PlanarPolygon> scan;
    for (int i = 0; i < 6; ++i) {
      const double x = random.uniform(-2.0, 1.0);
      const double y = random.uniform(-2.0, 1.0);
      const Rigid3 tilt{rotation_exp(0.03 * normal_vector(random)),
                        Vector3d(0.03 * random.normal(), 0.0, 0.0)};
      scan.push_back(transformed(
          tilt, rectangle(wall_at(0.0), x, y, x + random.uniform(0.2, 3.0), y + random.uniform(0.2, 3.0))));
    }
    return scan;
  };
  for (int trial = 0; trial < 20; ++trial) {
    const auto a = random_scan();
    const auto b = random_scan();
    for (const PlanarPolygon& polygon : a) {
      EXPECT_LE(agreement(polygon, b, 0.2), polygon.area_m2 + 1e-3);
      EXPECT_NEAR(agreement(polygon, {polygon}, 0.2), polygon.area_m2, 1e-3);
    }
    const double score = scan_agreement(a, b, 0.2);
    EXPECT_GT(score, 0.0);
    EXPECT_NEAR(score, scan_agreement(b, a, 0.2), 1e-9);
    const Rigid3 anywhere{rotation_exp(Vector3d(0.3, -1.0, 2.0)), Vector3d(5.0, -7.0, 3.0)};
    auto moved_a = a;
    auto moved_b = b;
    for (PlanarPolygon& p : moved_a) p = transformed(anywhere, p);
    for (PlanarPolygon& p : moved_b) p = transformed(anywhere, p);
    EXPECT_NEAR(scan_agreement(moved_a, moved_b, 0.2), score, 5e-3);
  }
}

TEST(ThresholdMatching, ListsThePairsWithinAllThreeThresholds) {
  const std::vector<PlanarPolygon> target{
      rectangle(wall_at(0.0), 0, 0, 4, 2), rectangle(wall_at(0.5), 0, 0, 4, 2),
      rectangle({Vector3d::UnitY(), 0.0}, 0, 0, 4, 2), rectangle(wall_at(0.0), 10, 0, 14, 2)};
  const Rigid3 target_from_source{rotation_exp(Vector3d(0.2, 0.1, -0.7)), Vector3d(3.0, 1.0, -2.0)};
  std::vector<PlanarPolygon> source;
  for (const PlanarPolygon& p : target) source.push_back(transformed(inverse(target_from_source), p));
  const auto matches = match_by_thresholds(source, target, target_from_source);
  ASSERT_EQ(matches.size(), 4U);
  for (const ThresholdMatch& match : matches) {
    EXPECT_EQ(match.source, match.target);
    EXPECT_NEAR(match.angle_rad, 0.0, 1e-9);
    EXPECT_NEAR(match.distance_m, 0.0, 1e-9);
    EXPECT_NEAR(match.overlap, 1.0, 1e-4);
    EXPECT_NEAR(match.overlap_m2, 8.0, 1e-3);
  }
  // Without the start the walls are tilted by 40 degrees: nothing is within the thresholds.
  EXPECT_TRUE(match_by_thresholds(source, target, Rigid3{}).empty());
}

TEST(ThresholdMatching, KeepsOnePartnerEach) {
  const std::vector<PlanarPolygon> target{rectangle(wall_at(0.0), 0, 0, 4, 2),
                                          rectangle(wall_at(0.1), 0, 0, 3, 2)};
  const auto matches = match_by_thresholds(target, target, Rigid3{});
  ASSERT_EQ(matches.size(), 2U);
  EXPECT_EQ(matches[0].source, 0);
  EXPECT_EQ(matches[0].target, 0);
  EXPECT_EQ(matches[1].target, 1);
}

}  // namespace
}  // namespace limen
