// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/features/scanner_up.h"

#include <cmath>

#include "support/synthetic_room.h"
#include <gtest/gtest.h>

#include "limen/base/angles.h"
#include "limen/base/random.h"
#include "limen/geometry/rigid.h"

namespace limen {
namespace {

/// A room about a tripod scanner that sees nothing below `lowest_deg`.
Scan station_scan(double lowest_deg) {
  return box_scan(40000, radians(lowest_deg), 1.5707);
}

Scan turned(Scan scan, const Matrix3d& rotation) {
  for (Vector3d& x : scan.points) x = rotation * x;
  for (Vector3d& x : scan.centres) x = rotation * x;
  return scan;
}

TEST(ScannerUp, IsOppositeTheBlindCone) {
  const Scan scan = station_scan(-60.0);
  for (const Vector3d& turn : {Vector3d(0, 0, 0), Vector3d(3.0, 0.2, 0), Vector3d(0.4, -1.2, 2.0)}) {
    const Matrix3d rotation = rotation_exp(turn);
    const std::optional<Vector3d> up = find_scanner_up(turned(scan, rotation));
    ASSERT_TRUE(up.has_value());
    EXPECT_GT(up->dot(rotation * Vector3d::UnitZ()), std::cos(radians(0.5)));
  }
}

TEST(ScannerUp, IsNotToldByAScannerThatSeesEverything) {
  EXPECT_FALSE(find_scanner_up(station_scan(-90.0)).has_value());
}

TEST(ScannerUp, IsNotToldWithoutACentre) {
  Scan scan = station_scan(-60.0);
  scan.centres.clear();
  EXPECT_FALSE(find_scanner_up(scan).has_value());
}

/// A vehicle's scan: ground 2 m under the path, a façade 6 m beside it.
TEST(ScannerUp, OfAVehicleIsTheGroundsNormal) {
  RandomStream stream(7);
  Scan scan;
  for (int i = 0; i < 60000; ++i) {
    const double x = stream.uniform(0.0, 30.0);
    const Vector3d noise(0.0, 0.003 * stream.normal(), 0.003 * stream.normal());
    scan.centres.emplace_back(x, 0.0, 2.0);
    scan.points.push_back(i % 2 == 0 ? Vector3d(x + noise.y(), stream.uniform(-8.0, 6.0), noise.z())
                                     : Vector3d(x, 6.0 + noise.y(), stream.uniform(0.0, 12.0)));
  }
  for (const Vector3d& turn : {Vector3d(0, 0, 0), Vector3d(1.7, 0.2, 0.5)}) {
    const Matrix3d rotation = rotation_exp(turn);
    const std::optional<Vector3d> up = find_scanner_up(turned(scan, rotation));
    ASSERT_TRUE(up.has_value());
    EXPECT_GT(up->dot(rotation * Vector3d::UnitZ()), std::cos(radians(0.5)));
  }
}

}  // namespace
}  // namespace limen
