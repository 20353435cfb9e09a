// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/planes/straight_scan.h"

#include <cmath>

#include <gtest/gtest.h>

#include "limen/base/random.h"

namespace limen {
namespace {

/// A drive of 40 s along x over level ground, past a wall on its left and one across its end, with an error
/// that comes and goes.
Scan bent_drive(double drift_m) {
  RandomStream random(1, 0);
  Scan scan;
  scan.level = true;
  for (int i = 0; i < 90000; ++i) {
    const double time = 40.0 * i / 90000.0;
    const double along = 2.0 * time + random.uniform(-3.0, 3.0);
    Vector3d x(along, random.uniform(-5.0, 6.0), 0.0);
    if (i % 3 == 1) x = {along, 6.0, random.uniform(0.0, 8.0)};
    x += 0.003 * random.normal() * (i % 3 == 1 ? Vector3d::UnitY() : Vector3d::UnitZ());
    const double wave = drift_m * std::sin(0.4 * time);
    const Vector3d error(0.0, wave, -0.5 * wave);
    scan.points.push_back(x + error);
    scan.centres.push_back(Vector3d(2.0 * time, 0.0, 2.0) + error);
    scan.times_s.push_back(time);
  }
  return scan;
}

/// Root mean square of the heights of what is ground.
double roughness(const Scan& scan) {
  double squares = 0.0;
  double count = 0.0;
  for (std::size_t i = 0; i < scan.size(); i += 3) {
    squares += scan.points[i].z() * scan.points[i].z();
    count += 1.0;
  }
  return std::sqrt(squares / count);
}

TEST(StraightScan, TakesOutWhatGroundAndWallsShow) {
  const Scan scan = bent_drive(0.015);
  const ScanDrift drift = scan_drift(scan);
  ASSERT_FALSE(drift.knots.empty());
  EXPECT_GT(roughness(scan), 0.0055);
  EXPECT_LT(roughness(straightened(scan, drift)), 0.0035);
  for (double time = 2.0; time < 38.0; time += 1.0)
    EXPECT_NEAR(drift.at(time).y() - drift.at(2.0).y(), 0.015 * (std::sin(0.4 * time) - std::sin(0.8)), 0.004)
        << time;
}

TEST(StraightScan, LeavesAStraightDriveAlone) {
  EXPECT_TRUE(scan_drift(bent_drive(0.0)).knots.empty());
}

TEST(StraightScan, TellsNothingWithoutTimes) {
  Scan scan = bent_drive(0.015);
  scan.times_s.clear();
  EXPECT_TRUE(scan_drift(scan).knots.empty());
}

}  // namespace
}  // namespace limen
