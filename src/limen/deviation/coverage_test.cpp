// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/deviation/coverage.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace limen {
namespace {

const Vector2d kPostM(0.12, 2.8);
constexpr double kTileM = 0.05;

/// The face y = 0 of a post, seen from y > 0.
FaceIndex post() {
  FlatFace face;
  face.plane = Plane{Vector3d::UnitY(), 0.0};
  face.frame = make_frame(face.plane, Vector3d::Zero());
  Eigen::AlignedBox2d box;
  for (const double x : {0.0, kPostM.x()}) {
    for (const double z : {0.0, kPostM.y()}) box.extend(face.frame.to_plane({x, 0.0, z}));
  }
  face.outline.outer = {box.corner(box.BottomLeft), box.corner(box.BottomRight), box.corner(box.TopRight),
                        box.corner(box.TopLeft)};
  return {{face}, 0.1};
}

/// Points a centimetre from each other on the post, or on a wall behind it.
Scan seen(double y, double from_z, double to_z) {
  Scan scan;
  scan.centres = {{0.06, 3.0, 1.4}};
  for (double x = 0.005; x < kPostM.x(); x += 0.01) {
    for (double z = from_z + 0.005; z < to_z; z += 0.01) scan.points.emplace_back(x, y, z);
  }
  return scan;
}

FaceCoverage coverage_of(const Scan& scan, const DeviationOptions& options) {
  const FaceIndex index = post();
  const ScanInModel placed(scan, {});
  PointFaces laid;
  for (const Vector3d& x : scan.points) laid.face.push_back(x.y() == 0.0 ? 0 : -1);
  FaceTiles tiles(index, kTileM);
  tiles.add(placed, laid, options);
  return tiles.coverage().front();
}

TEST(FaceTiles, CountNoMoreSurfaceThanThereIs) {
  const FaceCoverage whole = coverage_of(seen(0.0, 0.0, kPostM.y()), {});
  EXPECT_NEAR(whole.covered_m2, kPostM.prod(), 1e-9);
  EXPECT_EQ(whole.passed_m2, 0.0);
  const FaceCoverage half = coverage_of(seen(0.0, 0.0, 1.4), {});
  EXPECT_NEAR(half.covered_m2, 0.12 * 1.4, 1e-9);
  // From 3 m before the post a wall 1 m behind it is seen through three quarters of its height.
  EXPECT_NEAR(coverage_of(seen(-1.0, 0.0, kPostM.y()), {}).passed_m2, 0.75 * kPostM.prod(), 0.01);
}

TEST(FaceTiles, DoNotDependOnTheOrderOfPointsNorOnTheNumberOfRays) {
  DeviationOptions few;
  few.rays = 300;
  Scan scan = seen(0.0, 0.0, 1.4);
  const Scan behind = seen(-1.0, 1.5, kPostM.y());
  scan.points.insert(scan.points.end(), behind.points.begin(), behind.points.end());
  const FaceCoverage given = coverage_of(scan, few);
  EXPECT_EQ(given.covered_m2, coverage_of(scan, {}).covered_m2);
  EXPECT_GT(given.passed_m2, 0.0);
  std::reverse(scan.points.begin(), scan.points.end());
  EXPECT_EQ(coverage_of(scan, few).passed_m2, given.passed_m2);
}

}  // namespace
}  // namespace limen
