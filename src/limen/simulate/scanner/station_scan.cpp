// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/simulate/scanner/station_scan.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "limen/geometry/random_vectors.h"

namespace limen {

Matrix3d any_heading(RandomStream& random) {
  return rotation_exp({0.0, 0.0, random.uniform(0.0, 2.0 * std::numbers::pi)});
}

Matrix3d station_rotation(bool any_rotation, RandomStream& random) {
  if (!any_rotation) return any_heading(random);
  return uniform_rotation(random);
}

Vector3d rounded(const Vector3d& x) {
  return (x * 65536.0).array().round().matrix() / 65536.0;
}

Sweep sweep_of_points(std::size_t points, const std::function<ScanPattern(std::size_t pulses)>& pattern,
                      const std::function<Sweep(const ScanPattern&)>& fire) {
  const ScanPattern thin = pattern(20000);
  const double share = std::max(0.02, static_cast<double>(fire(thin).echoes.size()) /
                                          static_cast<double>(thin.lines * thin.pulses_per_line));
  return fire(pattern(static_cast<std::size_t>(std::lround(static_cast<double>(points) / share))));
}

Scan station_scan(std::string name, const Sweep& sweep, const Rigid3& scan_from_scene) {
  Scan scan;
  scan.name = std::move(name);
  scan.centres = {Vector3d::Zero()};
  for (const Echo& echo : sweep.echoes) {
    scan.points.push_back(scan_from_scene * echo.point);
    scan.intensities.push_back(echo.intensity);
  }
  return scan;
}

}  // namespace limen
