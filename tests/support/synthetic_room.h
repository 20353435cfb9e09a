// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
// A made-up scan for tests.
#pragma once

#include <algorithm>
#include <cmath>

#include "limen/base/random.h"
#include "limen/model/scan.h"

namespace limen {

/// A box of 6 x 5 x 3 m about its scanner at 0, 0, 0, seen evenly over azimuth and, from `lowest_rad` to
/// `highest_rad`, elevation; 2 mm noise.
inline Scan box_scan(std::size_t points, double lowest_rad, double highest_rad) {
  const Vector3d low(-2, -3, -1.5);
  const Vector3d high(4, 2, 1.5);
  RandomStream stream(5);
  Scan scan;
  scan.name = "box";
  for (std::size_t i = 0; i < points; ++i) {
    const double azimuth = stream.uniform(-3.14159265, 3.14159265);
    const double elevation = stream.uniform(lowest_rad, highest_rad);
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

}  // namespace limen
