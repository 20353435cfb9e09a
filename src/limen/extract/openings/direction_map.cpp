// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/openings/direction_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace limen {
namespace {

constexpr int kColumns = 1440;
constexpr int kRows = 720;
constexpr double kStep_rad = 2.0 * std::numbers::pi / kColumns;
constexpr double kPole_rad = 1.4;  // elevations beyond are not distinguished by azimuth

/// arctan(t) / t of t^2 in [0, 1]: interpolated at Chebyshev's nodes, off by 2e-9 at most.
constexpr std::array<double, 10> kArctan = {
    0.999999997161,   -0.33333276292,  0.199980752807, -0.142600160801, 0.109323414917,
    -0.0834972494866, 0.0570895556962, -0.03035186463, 0.0104876492052, -0.00170117005946};

/// As std::atan2, which is exact to the last digit and takes three times as long.
double angle_of(double y, double x) {
  const double larger = std::max(std::abs(x), std::abs(y));
  if (!(larger > 0.0)) return 0.0;
  const double t = std::min(std::abs(x), std::abs(y)) / larger;
  double sum = 0.0;
  for (std::size_t k = kArctan.size(); k-- > 0;) sum = sum * t * t + kArctan[k];
  double angle = sum * t;
  if (std::abs(y) > std::abs(x)) angle = 0.5 * std::numbers::pi - angle;
  if (x < 0.0) angle = std::numbers::pi - angle;
  return y < 0.0 ? -angle : angle;
}

double azimuth_of(const Vector3d& ray) {
  return angle_of(ray.y(), ray.x()) + std::numbers::pi;
}

double elevation_of(const Vector3d& ray) {
  return angle_of(ray.z(), ray.head<2>().norm());
}

int row_of(double elevation) {
  return std::clamp(static_cast<int>((elevation + 0.5 * std::numbers::pi) / kStep_rad), 0, kRows - 1);
}

}  // namespace

DirectionMap::DirectionMap(const Scan& scan, const Vector3d& centre)
    : centre_(centre), answered_(static_cast<std::size_t>(kColumns) * kRows, 0) {
  for (const Vector3d& point : scan.points) {
    const Vector3d ray = point - centre;
    const int column = std::clamp(static_cast<int>(azimuth_of(ray) / kStep_rad), 0, kColumns - 1);
    answered_[static_cast<std::size_t>(row_of(elevation_of(ray)) * kColumns + column)] = 1;
  }
}

bool DirectionMap::silent(const Vector3d& x, double radius_rad) const {
  if (answered_.empty()) return false;
  const Vector3d ray = x - centre_;
  const double elevation = elevation_of(ray);
  if (std::abs(elevation) + radius_rad > kPole_rad) return false;
  const double azimuth = azimuth_of(ray);
  const double across_rad = radius_rad / std::cos(elevation);
  const int first = static_cast<int>(std::floor((azimuth - across_rad) / kStep_rad));
  const int last = static_cast<int>(std::floor((azimuth + across_rad) / kStep_rad));
  for (int row = row_of(elevation - radius_rad); row <= row_of(elevation + radius_rad); ++row) {
    for (int c = first; c <= last; ++c) {
      const int column = ((c % kColumns) + kColumns) % kColumns;
      if (answered_[static_cast<std::size_t>(row * kColumns + column)] != 0) return false;
    }
  }
  return true;
}

}  // namespace limen
