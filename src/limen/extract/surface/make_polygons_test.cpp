// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/surface/make_polygons.h"

#include <cmath>

#include <gtest/gtest.h>

#include "limen/base/error.h"
#include "limen/base/random.h"
#include "limen/extract/surface/sample_surface.h"

namespace limen {
namespace {

/// A wall of 4 x 3 m in the plane y = 2 with a window of 1 x 1 m, and a second part 1 m further along x,
/// 1 x 3 m; 2 mm noise, 2 500 points per square metre; seen from the origin.
struct Wall {
  Scan scan;
  PlaneLabels planes;

  Wall() {
    RandomStream random(1);
    PointMoments moments;
    while (scan.size() < 35000) {
      const double x = random.uniform(0.0, 6.0);
      const double z = random.uniform(0.0, 3.0);
      const bool window = x > 1.5 && x < 2.5 && z > 1.0 && z < 2.0;
      if (window || (x > 4.0 && x < 5.0)) continue;
      scan.points.emplace_back(x, 2.0 + 0.002 * random.normal(), z);
      moments.add(scan.points.back());
    }
    planes.fits = {fit_plane(moments)};
    planes.labels.assign(scan.size(), 0);
    scan.centres = {Vector3d::Zero()};
  }
};

TEST(MakePolygons, PartsAndHoles) {
  const Wall wall;
  const std::vector<PlanarPolygon> polygons = make_polygons(wall.scan, wall.planes);
  ASSERT_EQ(polygons.size(), 1U);
  const PlanarPolygon& polygon = polygons[0];
  ASSERT_EQ(polygon.parts.size(), 2U);
  ASSERT_EQ(polygon.parts[0].holes.size(), 1U);
  EXPECT_TRUE(polygon.parts[1].holes.empty());
  EXPECT_NEAR(area(polygon.parts[0]), 11.0, 0.3);
  EXPECT_NEAR(area(polygon.parts[1]), 3.0, 0.15);
  EXPECT_NEAR(std::abs(signed_area(polygon.parts[0].holes[0])), 1.0, 0.12);
  EXPECT_NEAR(polygon.area_m2, area(polygon.parts), 1e-12);
  EXPECT_EQ(polygon.inliers, wall.scan.size());
  EXPECT_NEAR(polygon.rms_m, 0.002, 2e-4);
  // The normal points to the scanner, and the frame goes with it.
  EXPECT_TRUE(polygon.oriented);
  EXPECT_LT(polygon.plane.normal.y(), -0.999);
  EXPECT_NEAR(polygon.frame.u.cross(polygon.frame.v).dot(polygon.plane.normal), 1.0, 1e-9);
  EXPECT_TRUE(contains(polygon.parts[0], polygon.frame.to_plane({1.0, 2.0, 0.5})));
  EXPECT_FALSE(contains(polygon.parts[0], polygon.frame.to_plane({2.0, 2.0, 1.5})));
}

TEST(MakePolygons, TheAlphaAskedForClosesGaps) {
  const Wall wall;
  PolygonOptions options;
  options.alpha_m = 0.9;
  const std::vector<PlanarPolygon> polygons = make_polygons(wall.scan, wall.planes, options);
  ASSERT_EQ(polygons[0].parts.size(), 1U);
  EXPECT_NEAR(polygons[0].area_m2, 18.0, 0.5);
}

TEST(MakePolygons, WithoutAnOpticalCentreTheyAreNotOriented) {
  Wall wall;
  wall.scan.centres.clear();
  EXPECT_FALSE(make_polygons(wall.scan, wall.planes)[0].oriented);
  // Seen from both sides.
  wall.scan.centres.assign(wall.scan.size(), Vector3d::Zero());
  for (std::size_t i = 0; i < wall.scan.size(); i += 2) wall.scan.centres[i] = Vector3d(0, 4, 0);
  EXPECT_FALSE(make_polygons(wall.scan, wall.planes)[0].oriented);
}

TEST(MakePolygons, OfNothing) {
  EXPECT_TRUE(make_polygons(Scan{}, PlaneLabels{}).empty());
  EXPECT_THROW(make_polygons(Scan{}, PlaneLabels{}, {.alpha_m = -1.0}), Error);
}

TEST(SampleSurface, CoversTheSurfaceEvenly) {
  Wall wall;
  // Clutter before the wall: a cluster of ten points, and a lone one.
  for (int i = 0; i < 10; ++i) wall.scan.points.emplace_back(1.01 + 0.001 * i, 1.01, 1.01);
  wall.scan.points.emplace_back(3.0, 1.0, 1.0);
  wall.planes.labels.resize(wall.scan.size(), -1);
  const std::vector<PlanarPolygon> polygons = make_polygons(wall.scan, wall.planes);
  const std::vector<SurfaceSample> samples = sample_surface(wall.scan, wall.planes.labels, polygons);
  double area_m2 = 0.0;
  double count = 0.0;
  std::size_t clutter = 0;
  for (const SurfaceSample& sample : samples) {
    if (sample.plane < 0) {
      ++clutter;
      EXPECT_TRUE(sample.normal.isZero());
      EXPECT_LT((sample.mean - Vector3d(1.0145, 1.01, 1.01)).norm(), 1e-9);
      continue;
    }
    area_m2 += static_cast<double>(sample.area_m2);
    count += static_cast<double>(sample.count);
    EXPECT_NEAR(sample.mean.y(), 2.0, 0.009 / std::sqrt(static_cast<double>(sample.count)));
    EXPECT_EQ(sample.normal, polygons[0].plane.normal);
  }
  EXPECT_EQ(clutter, 1U);
  EXPECT_EQ(count, 35000.0);
  EXPECT_NEAR(area_m2, 14.0, 0.6);
  EXPECT_THROW(sample_surface(wall.scan, wall.planes.labels, polygons, {.tile_m = 0.0}), Error);
}

}  // namespace
}  // namespace limen
