// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/solve_project.h"

#include <cmath>

#include <gtest/gtest.h>

#include "limen/base/error.h"
#include "limen/simulate/scene.h"

namespace limen {
namespace {

TEST(SolveProject, PlacesScansOfMemoryWhereTheyBelong) {
  SceneOptions options;
  options.name = "room";
  options.stations = 2;
  options.points_indoor = 60000;
  const SimulatedCase made = simulate(options);
  const ProjectResult result = solve_project(made.scans);
  ASSERT_EQ(result.scans.size(), 2U);
  EXPECT_EQ(result.scans[1].file, "scan_2");
  ASSERT_TRUE(result.scans[0].frame_from_scan && result.scans[1].frame_from_scan);
  const Rigid3 found = inverse(*result.scans[1].frame_from_scan) * *result.scans[0].frame_from_scan;
  const Rigid3 truth = true_target_from_source(made.truth, 0, 1);
  EXPECT_LT((found.translation - truth.translation).norm(), 0.005);
  EXPECT_THROW(solve_project({}), Error);
}

TEST(SolveProject, PointsOnANationalGridLoseNothing) {
  const Vector3d x(652300.1234, 6862100.5678, 31.0);
  const Scan scan = scan_of_points({x, x + Vector3d(0, 0, 1)});
  EXPECT_LT(scan.points.front().norm(), 200.0);
  EXPECT_LT((scan.local_origin + scan.points.front() - x).norm(), 1e-9);
  EXPECT_THROW(scan_of_points({}), Error);
  EXPECT_THROW(scan_of_points({x, Vector3d(0, std::nan(""), 0)}), Error);
}

}  // namespace
}  // namespace limen
