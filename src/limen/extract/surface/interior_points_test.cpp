// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/surface/interior_points.h"

#include <cmath>

#include <gtest/gtest.h>

#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/base/random.h"
#include "limen/extract/surface/facades.h"
#include "limen/geometry/random_vectors.h"

namespace limen {
namespace {

Ring rectangle(double x0, double y0, double x1, double y1) {
  return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
}

/// A wall in the plane y = offset, [x0, x1] x [z0, z1] with holes, seen from smaller y.
PlanarPolygon wall(double offset, const Ring& outer, const std::vector<Ring>& holes) {
  PlanarPolygon polygon;
  polygon.plane = {-Vector3d::UnitY(), -offset};
  polygon.frame = {Vector3d(0.0, offset, 0.0), Vector3d::UnitX(), Vector3d::UnitZ()};
  polygon.parts = {{outer, holes}};
  polygon.area_m2 = area(polygon.parts);
  polygon.centroid = polygon.frame.origin;
  polygon.oriented = true;
  return polygon;
}

PlanarPolygon house() {
  return wall(10.0, rectangle(0, 0, 10, 8), {rectangle(2, 3, 3, 5), rectangle(6, 3, 7, 5)});
}

Scan ray(const Vector3d& centre, const Vector3d& point) {
  Scan scan;
  scan.name = "ray";
  scan.points = {point};
  scan.centres = {centre};
  return scan;
}

std::size_t crossings_of(const Scan& scan, const PlanarPolygon& polygon,
                         const InteriorPointOptions& options = {}) {
  return find_interior_points(scan, {polygon}, {0}, options).size();
}

TEST(InteriorPoints, AreSeenThroughTheHolesOfTheFacade) {
  // The window is a hole of the polygon, and yet the ray through it counts.
  const Scan scan = ray({2.5, 0.0, 4.0}, {2.5, 15.0, 4.0});
  const auto found = find_interior_points(scan, {PlanarPolygon{}, house()}, {1});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].point, 0U);
  EXPECT_EQ(found[0].wall, 1);
  EXPECT_NEAR((found[0].at - Vector2d(2.5, 4.0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR(found[0].depth_m, 5.0, 1e-12);
}

TEST(InteriorPoints, NeedACrossingStrictlyBetweenScannerAndPoint) {
  EXPECT_EQ(crossings_of(ray({2.5, 0, 4}, {2.5, 9.0, 4}), house()), 0U);     // before the wall
  EXPECT_EQ(crossings_of(ray({2.5, 12, 4}, {2.5, 20.0, 4}), house()), 0U);   // scanner inside
  EXPECT_EQ(crossings_of(ray({2.5, 20, 4}, {2.5, 5.0, 4}), house()), 0U);    // from behind
  EXPECT_EQ(crossings_of(ray({12.0, 0, 4}, {12.0, 20.0, 4}), house()), 0U);  // past the house
  EXPECT_EQ(crossings_of(ray({2.5, 0, 4}, {2.5, 10.5, 4}), house()), 0U);    // not 1 m behind
  PlanarPolygon unknown_side = house();
  unknown_side.oriented = false;
  EXPECT_EQ(crossings_of(ray({2.5, 20, 4}, {2.5, 5.0, 4}), unknown_side), 1U);
  InteriorPointOptions near;
  near.min_beyond_m = 0.1;
  EXPECT_EQ(crossings_of(ray({2.5, 0, 4}, {2.5, 10.5, 4}), house(), near), 1U);
}

TEST(InteriorPoints, BulgesAtGrazingIncidenceAreNotBehind) {
  // 2 m along the ray from the crossing, but 4 cm behind the plane.
  const Scan scan = ray({-90.0, 8.0, 4.0}, {2.0, 10.04, 4.0});
  EXPECT_EQ(crossings_of(scan, house()), 0U);
  InteriorPointOptions shallow;
  shallow.min_depth_m = 0.01;
  EXPECT_EQ(crossings_of(scan, house(), shallow), 1U);
}

TEST(InteriorPoints, TakeTheFirstOfSeveralWalls) {
  const std::vector<PlanarPolygon> walls{wall(14.0, rectangle(0, 0, 10, 8), {}), house()};
  const auto found = find_interior_points(ray({2.5, 0, 4}, {2.5, 20, 4}), walls, {0, 1});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].wall, 1);
}

TEST(InteriorPoints, EachPointHasItsOwnCentre) {
  Scan scan;
  for (int i = 0; i < 1000; ++i) {
    scan.centres.emplace_back(0.02 * i - 4.99, 0.0, 2.0);
    scan.points.emplace_back(0.02 * i - 4.99, 12.0, 2.0);
  }
  const auto found = find_interior_points(scan, {house()}, {0});
  EXPECT_EQ(found.size(), 500U);  // x between 0 and 10
  for (const Crossing& crossing : found) EXPECT_NEAR(crossing.at.x(), 0.02 * crossing.point - 4.99, 1e-9);
  EXPECT_EQ(subset(scan, point_indices(found)).size(), found.size());
}

/// Rays against walls one by one, as the paper says it.
std::vector<std::int32_t> brute_force(const Scan& scan, const std::vector<PlanarPolygon>& walls) {
  std::vector<std::int32_t> behind(scan.size(), -1);
  for (std::size_t i = 0; i < scan.size(); ++i) {
    double first = 2.0;
    for (std::size_t k = 0; k < walls.size(); ++k) {
      const double a = walls[k].plane.signed_distance(scan.centre(i));
      const double b = walls[k].plane.signed_distance(scan.points[i]);
      if (a <= 0.0 || b > -0.1) continue;
      const double share = a / (a - b);
      const Vector3d hit = scan.centre(i) + share * (scan.points[i] - scan.centre(i));
      if ((scan.points[i] - hit).norm() < 1.0 || share >= first) continue;
      if (!contains(walls[k].parts[0].outer, walls[k].frame.to_plane(hit))) continue;
      first = share;
      behind[i] = static_cast<std::int32_t>(k);
    }
  }
  return behind;
}

TEST(InteriorPoints, AreThoseOfBruteForceForAnyNumberOfThreads) {
  RandomStream random(1);
  std::vector<PlanarPolygon> walls;
  std::vector<int> all;
  for (int k = 0; k < 12; ++k) {
    const double x = random.uniform(-20.0, 10.0);
    PlanarPolygon made =
        wall(random.uniform(5.0, 25.0), rectangle(x, 0, x + random.uniform(2.0, 12.0), 6), {});
    made.parts[0].outer.insert(made.parts[0].outer.begin() + 3, Vector2d(x + 1.0, 7.5));
    walls.push_back(made);
    all.push_back(k);
  }
  Scan scan;
  for (int i = 0; i < 40000; ++i) {
    scan.centres.emplace_back(1e-3 * i - 20.0, random.uniform(-0.1, 0.1), 2.0);
    scan.points.push_back(uniform_vector(Vector3d(-30.0, -5.0, -1.0), Vector3d(30.0, 40.0, 15.0), random));
  }
  InteriorPointOptions exact;
  exact.outline = {0.0, 0.0};
  const std::vector<std::int32_t> expected = brute_force(scan, walls);
  const int before = thread_count();
  for (const int threads : {1, 3}) {
    set_thread_count(threads);
    std::vector<std::int32_t> behind(scan.size(), -1);
    for (const Crossing& crossing : find_interior_points(scan, walls, all, exact))
      behind[crossing.point] = crossing.wall;
    std::size_t different = 0;
    for (std::size_t i = 0; i < behind.size(); ++i) different += behind[i] != expected[i] ? 1U : 0U;
    EXPECT_LE(different, 2U);  // outlines are rounded to 10 um
  }
  set_thread_count(before);
  EXPECT_GT(std::count_if(expected.begin(), expected.end(), [](int wall) { return wall >= 0; }), 5000);
}

TEST(InteriorPoints, NeedAnOpticalCentre) {
  Scan scan = ray({0, 0, 0}, {1, 1, 1});
  scan.centres.clear();
  EXPECT_THROW(find_interior_points(scan, {house()}, {0}), Error);
  EXPECT_TRUE(find_interior_points(Scan{}, {house()}, {0}).empty());
  InteriorPointOptions options;
  options.min_depth_m = 0.0;
  EXPECT_THROW(find_interior_points(ray({0, 0, 0}, {1, 1, 1}), {house()}, {0}, options), Error);
}

TEST(Facades, AreLargeAndVertical) {
  PlanarPolygon tilted = house();
  const Rigid3 tilt{rotation_exp(Vector3d(radians(5.0), 0.0, 0.0)), Vector3d::Zero()};
  tilted.plane = transformed(tilt, tilted.plane);
  PlanarPolygon leaning = house();
  leaning.plane =
      transformed({rotation_exp(Vector3d(radians(2.0), 0.0, 0.0)), Vector3d::Zero()}, leaning.plane);
  PlanarPolygon floor = house();
  floor.plane = {Vector3d::UnitZ(), 0.0};
  const std::vector<PlanarPolygon> polygons{
      wall(1.0, rectangle(0, 0, 1, 2), {}),  // small
      tilted, leaning, floor, wall(5.0, rectangle(0, 0, 20, 8), {}),
      wall(5.0, rectangle(0, 0, 30, 0.5), {}),  // a kerb
      // nearly all glass
      wall(6.0, rectangle(0, 0, 4, 3), {rectangle(0.1, 0.1, 3.9, 2.9)})};
  EXPECT_EQ(find_facades(polygons, Vector3d::UnitZ()), (std::vector<int>{4, 2, 6}));
}

TEST(WallOutline, FillsHolesAndClosesNarrowGaps) {
  PlanarPolygon split = wall(0.0, rectangle(0, 0, 4, 3), {rectangle(1, 1, 2, 2)});
  split.parts.push_back({rectangle(0, 3.3, 4, 6), {}});  // a cornice between
  const auto outline = [&](double close_gaps_m) { return wall_outline({split}, 0, {close_gaps_m, 0.0}); };
  EXPECT_EQ(outline(0.0).size(), 2U);
  EXPECT_NEAR(area(outline(0.0)), 12.0 + 10.8, 1e-3);
  ASSERT_EQ(outline(0.5).size(), 1U);
  EXPECT_NEAR(area(outline(0.5)), 24.0, 0.1);
  EXPECT_EQ(outline(0.2).size(), 2U);
  EXPECT_TRUE(wall_outline({PlanarPolygon{}}, 0).empty());
}

TEST(WallOutline, TakesPiecesInReliefButNotTheHouseNextDoor) {
  const auto piece = [](double offset, const Ring& ring) {
    PlanarPolygon made = wall(offset, ring, {});
    made.centroid = made.frame.to_space(ring[0]);
    return made;
  };
  PlanarPolygon from_inside = piece(10.05, rectangle(0, -9, 4, 0));
  from_inside.plane = from_inside.plane.flipped();
  const std::vector<PlanarPolygon> polygons{piece(10.0, rectangle(0, 3, 4, 8)),
                                            piece(9.94, rectangle(0, 0, 4, 2.8)),  // a plinth
                                            piece(9.5, rectangle(0, 0, 4, 9)),     // a balcony
                                            piece(10.0, rectangle(6, 0, 9, 8)),    // next door
                                            from_inside};
  EXPECT_NEAR(area(wall_outline(polygons, 0, {0.5, 0.0})), 20.0, 0.1);
  EXPECT_NEAR(area(wall_outline(polygons, 0, {0.5, 0.1})), 32.0, 0.1);
  EXPECT_NEAR(area(wall_outline(polygons, 1, {0.5, 0.1})), 32.0, 0.1);
  EXPECT_THROW(wall_outline(polygons, 0, {-1.0, 0.1}), Error);
}

TEST(OutlineRaster, AnswersAsTheExactTest) {
  RandomStream random(2);
  for (int trial = 0; trial < 20; ++trial) {
    Polygon star;
    for (int i = 0; i < 25; ++i) {
      const double angle = 0.2513 * i;
      star.outer.push_back(random.uniform(0.3, 2.0) * Vector2d(std::cos(angle), std::sin(angle)));
    }
    const OutlineRaster raster({star, {rectangle(3, -1, 4, 1), {}}}, 0.02 + 0.05 * random.uniform());
    for (int i = 0; i < 3000; ++i) {
      const Vector2d p = uniform_vector(Vector2d(-2.5, -2.5), Vector2d(4.5, 2.5), random);
      const bool expected = contains(star.outer, p) || (p.x() > 3 && p.x() < 4 && p.y() > -1 && p.y() < 1);
      ASSERT_EQ(raster.contains(p), expected) << p.transpose();
    }
  }
  EXPECT_FALSE(OutlineRaster({}, 0.1).contains(Vector2d::Zero()));
}

}  // namespace
}  // namespace limen
