// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/sight/estimate_centre.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "limen/model/features.h"

namespace limen {
namespace {

constexpr double kTileM = 0.3;

/// Tiles of the walls and the floor of a hall of 30 x 12 x 4 m, as a scanner at the origin, 1.5 m above the
/// floor, covers them; no denser than `most_per_m2`.
Features hall(double most_per_m2) {
  const std::vector<Plane> planes = {{Vector3d::UnitZ(), -1.5},
                                     {-Vector3d::UnitX(), -24.0},
                                     {Vector3d::UnitX(), -6.0},
                                     {-Vector3d::UnitY(), -8.0},
                                     {Vector3d::UnitY(), -4.0}};
  Features features;
  for (const Plane& plane : planes) {
    PlanarPolygon polygon;
    polygon.plane = plane;
    polygon.area_m2 = 100.0;
    const auto number = static_cast<std::int32_t>(features.planes.size());
    features.planes.push_back(polygon);
    const Vector3d along = std::abs(plane.normal.z()) > 0.5 ? Vector3d::UnitX() : Vector3d::UnitZ();
    const Vector3d across = plane.normal.cross(along);
    for (int i = -80; i <= 80; ++i) {
      for (int j = -80; j <= 80; ++j) {
        const Vector3d at = plane.project(Vector3d::Zero()) + kTileM * (i * along + j * across);
        if (at.x() < -6.01 || at.x() > 24.01 || at.y() < -4.01 || at.y() > 8.01) continue;
        if (at.z() < -1.51 || at.z() > 2.51) continue;
        const double range = at.norm();
        const double flat = std::hypot(at.x(), at.y());
        const double law = 1e5 * std::abs(plane.offset) / (range * range * std::max(0.05 * range, flat));
        SurfaceSample sample;
        sample.mean = at;
        sample.plane = number;
        sample.area_m2 = static_cast<float>(kTileM * kTileM);
        sample.count = static_cast<float>(std::min(law, most_per_m2) * kTileM * kTileM);
        features.samples.push_back(sample);
      }
    }
  }
  return features;
}

TEST(EvenlyThinned, IsACloudWhoseDensityHasABound) {
  EXPECT_FALSE(evenly_thinned(hall(1e9)));
  EXPECT_TRUE(evenly_thinned(hall(2000.0)));
  EXPECT_TRUE(evenly_thinned(hall(700.0)));
  EXPECT_TRUE(evenly_thinned(hall(250.0)));
}

}  // namespace
}  // namespace limen
