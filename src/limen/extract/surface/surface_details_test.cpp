// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/surface/surface_details.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "limen/base/random.h"
#include "limen/geometry/random_vectors.h"

namespace limen {
namespace {

/// Points on the square [0, 0.5]^2 of the plane x = 2.04, a ball about (1, 1, 0.5), seen from the origin.
Scan box_and_ball() {
  Scan scan;
  scan.centres = {Vector3d::Zero()};
  RandomStream random(3);
  for (int i = 0; i < 4000; ++i)
    scan.points.emplace_back(2.04 + 0.001 * random.normal(), 0.5 * random.uniform(), 0.5 * random.uniform());
  for (int i = 0; i < 4000; ++i) {
    const Vector3d d = normal_vector(random);
    scan.points.push_back(Vector3d(-2.05, 1.05, 0.55) + 0.04 * d.normalized());
  }
  return scan;
}

TEST(SurfaceDetails, FlatPiecesLieOnTheirFaceAndLookAtTheScanner) {
  const Scan scan = box_and_ball();
  const std::vector<std::int32_t> labels(scan.size(), -1);
  const std::vector<SurfaceDetail> details = find_surface_details(scan, labels, {});
  ASSERT_GE(details.size(), 20U);
  std::size_t round = 0;
  for (const SurfaceDetail& detail : details) {
    if (!detail.flat()) {
      ++round;
      EXPECT_LT(detail.mean.x(), -1.9);  // the ball's
      continue;
    }
    EXPECT_NEAR(detail.mean.x(), 2.04, 5e-4);  // the ball gives none
    EXPECT_LT(detail.normal.x(), -0.999);
    EXPECT_LT(detail.sigma_m, 4e-4);
  }
  EXPECT_GE(round, 1U);
}

TEST(SurfaceDetails, PlanesOfTheBuildingGiveNone) {
  const Scan scan = box_and_ball();
  PlanarPolygon wall;
  wall.frame = {Vector3d(2.04, 0, 0), Vector3d::UnitY(), Vector3d::UnitZ()};
  wall.plane = {-Vector3d::UnitX(), 2.04};
  wall.parts = {{{{0, 0}, {2.5, 0}, {2.5, 1}, {0, 1}}, {}}};
  ASSERT_TRUE(of_building(wall));
  std::vector<std::int32_t> labels(scan.size(), -1);
  for (std::size_t i = 0; i < 4000; ++i) labels[i] = 0;
  for (const SurfaceDetail& detail : find_surface_details(scan, labels, {wall}))
    EXPECT_LT(detail.mean.x(), 0);
  wall.parts = {{{{0, 0}, {0.5, 0}, {0.5, 0.5}, {0, 0.5}}, {}}};
  wall.area_m2 = 0.25;
  EXPECT_FALSE(of_building(wall));
  const std::vector<SurfaceDetail> board = find_surface_details(scan, labels, {wall});
  EXPECT_TRUE(
      std::any_of(board.begin(), board.end(), [](const auto& detail) { return detail.mean.x() > 0; }));
}

}  // namespace
}  // namespace limen
