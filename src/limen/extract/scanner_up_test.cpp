// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/scanner_up.h"

#include <cmath>

#include <gtest/gtest.h>

#include "limen/base/angles.h"
#include "limen/base/random.h"
#include "limen/geometry/rigid.h"

namespace limen {
namespace {

/// A box room of 6 x 5 x 3 m about a tripod scanner that sees nothing below `lowest_deg`.
Scan box_scan(double lowest_deg) {
  const Vector3d low(-2, -3, -1.5);
  const Vector3d high(4, 2, 1.5);
  RandomStream stream(5);
  Scan scan;
  for (std::size_t i = 0; i < 40000; ++i) {
    const double azimuth = stream.uniform(-3.14159265, 3.14159265);
    const double elevation = stream.uniform(radians(lowest_deg), 1.5707);
    const Vector3d ray(std::cos(azimuth) * std::cos(elevation), std::sin(azimuth) * std::cos(elevation),
                       std::sin(elevation));
    double range = 1e9;
    for (int axis = 0; axis < 3; ++axis) {
      const double wall = ray[axis] > 0 ? high[axis] : low[axis];
      if (std::abs(ray[axis]) > 1e-9) range = std::min(range, wall / ray[axis]);
    }
    scan.points.push_back((range + 0.002 * stream.normal()) * ray);
  }
  scan.centres = {Vector3d::Zero()};
  return scan;
}

Scan turned(Scan scan, const Matrix3d& rotation) {
  for (Vector3d& x : scan.points) x = rotation * x;
  for (Vector3d& x : scan.centres) x = rotation * x;
  return scan;
}

TEST(ScannerUp, IsOppositeTheBlindCone) {
  const Scan scan = box_scan(-60.0);
  for (const Vector3d& turn : {Vector3d(0, 0, 0), Vector3d(3.0, 0.2, 0), Vector3d(0.4, -1.2, 2.0)}) {
    const Matrix3d rotation = rotation_exp(turn);
    const std::optional<Vector3d> up = find_scanner_up(turned(scan, rotation));
    ASSERT_TRUE(up.has_value());
    EXPECT_GT(up->dot(rotation * Vector3d::UnitZ()), std::cos(radians(0.5)));
  }
}

TEST(ScannerUp, IsNotToldByAScannerThatSeesEverything) {
  EXPECT_FALSE(find_scanner_up(box_scan(-90.0)).has_value());
}

TEST(ScannerUp, IsNotToldWithoutACentre) {
  Scan scan = box_scan(-60.0);
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
