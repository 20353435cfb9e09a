// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/judge/common_surfaces.h"

#include <cmath>

#include <gtest/gtest.h>

#include "limen/base/random.h"

namespace limen {
namespace {

constexpr double kTileM = 0.25;

/// A square of `edge_m` by tiles, each off by normal errors of `noise_m`.
void add_square(const Plane& plane, double edge_m, double noise_m, RandomStream& random, Features& features) {
  PlanarPolygon polygon;
  polygon.plane = plane;
  polygon.frame = make_frame(plane, Vector3d::Zero());
  polygon.frame.origin = plane.offset * plane.normal;
  polygon.parts = {{{{0.0, 0.0}, {edge_m, 0.0}, {edge_m, edge_m}, {0.0, edge_m}}, {}}};
  polygon.area_m2 = edge_m * edge_m;
  polygon.inliers = 10000;
  polygon.oriented = true;
  polygon.centroid = polygon.frame.to_space({0.5 * edge_m, 0.5 * edge_m});
  const auto index = static_cast<std::int32_t>(features.planes.size());
  features.planes.push_back(polygon);
  for (double u = 0.5 * kTileM; u < edge_m; u += kTileM) {
    for (double v = 0.5 * kTileM; v < edge_m; v += kTileM) {
      const Vector3d at = polygon.frame.to_space({u, v}) + noise_m * random.normal() * plane.normal;
      features.samples.push_back({at, plane.normal, index, 0.06F, 50.0F});
    }
  }
}

/// A floor and two walls, the first of which is `off_m` from its place.
Features room(double off_m, double noise_m, std::uint64_t seed) {
  RandomStream random(seed, 0);
  Features features;
  features.noise_m = noise_m;
  add_square({Vector3d::UnitZ(), 0.0}, 4.0, noise_m, random, features);
  add_square({Vector3d::UnitX(), off_m}, 3.0, noise_m, random, features);
  add_square({Vector3d::UnitY(), 0.0}, 3.0, noise_m, random, features);
  return features;
}

CommonSurfaces asked(const Features& source, const Features& target, const Rigid3& pose = {}) {
  ScanView from;
  from.features = &source;
  ScanView to;
  to.features = &target;
  return CommonSurfaceFinder(from, BuiltPlanes(from), to, BuiltPlanes(to))(pose);
}

TEST(CommonSurfaces, HowFarAWallStandsOffIsMeasured) {
  const CommonSurfaces seen = asked(room(0.006, 0.001, 1), room(0.0, 0.001, 2));
  ASSERT_EQ(seen.all.size(), 3U);
  for (const CommonSurface& one : seen.all) {
    const double off_m = std::abs(one.normal.x()) > 0.5 ? 0.006 : 0.0;
    const double sigma_m = std::sqrt(one.measured(0, 0));
    EXPECT_LT(sigma_m, 0.0005);
    EXPECT_NEAR(one.deviation[0], off_m, 4.0 * sigma_m);
    EXPECT_NEAR(one.deviation[1], 0.0, 4.0 * std::sqrt(one.measured(1, 1)));
    EXPECT_TRUE(one.long_enough);
  }
}

TEST(CommonSurfaces, SlopesAreThoseOfATurn) {
  const Vector3d turn(0.004, 0.0, 0.0);
  const Features features = room(0.0, 0.0005, 1);
  const CommonSurfaces seen = asked(features, features, {rotation_exp(turn), Vector3d::Zero()});
  ASSERT_EQ(seen.all.size(), 3U);
  for (const CommonSurface& one : seen.all) {
    for (std::size_t k = 0; k < 2; ++k) {
      const auto row = static_cast<Eigen::Index>(k) + 1;
      EXPECT_NEAR(one.deviation[row], turn.dot(one.along[k].cross(one.normal)), 0.0005);
    }
    EXPECT_NEAR(one.deviation[0], one.normal.dot(turn.cross(one.at)), 0.001);
  }
}

TEST(CommonSurfaces, ScatterIsTheSensors) {
  for (const double noise_m : {0.001, 0.01}) {
    // The tiles' own scatter, whatever their number of points lets expect.
    const double scatter_m = asked(room(0.004, noise_m, 1), room(0.0, noise_m, 2)).scatter_m;
    EXPECT_GT(scatter_m, 0.8 * noise_m);
    EXPECT_LT(scatter_m, 1.2 * noise_m);
  }
}

TEST(CommonSurfaces, LayersOfOneWallCountOnce) {
  Features target = room(0.0, 0.001, 2);
  RandomStream random(3, 0);
  add_square({Vector3d::UnitX(), 0.03}, 2.5, 0.001, random, target);  // a panel before the wall
  const CommonSurfaces seen = asked(room(0.0, 0.001, 1), target);
  EXPECT_EQ(seen.all.size(), 3U);
}

TEST(CommonSurfaces, WhatFacesTheOtherWayIsAnother) {
  Features target = room(0.0, 0.001, 2);
  target.planes[1].plane = target.planes[1].plane.flipped();
  EXPECT_EQ(asked(room(0.0, 0.001, 1), target).all.size(), 2U);
}

}  // namespace
}  // namespace limen
