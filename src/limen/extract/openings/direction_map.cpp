// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/openings/direction_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace limen {
namespace {

constexpr int kColumns = 1440;
constexpr int kRows = 720;
constexpr double kStep_rad = 2.0 * std::numbers::pi / kColumns;
constexpr double kPole_rad = 1.4;  // elevations beyond are not told apart by azimuth

double azimuth_of(const Vector3d& ray) {
  return std::atan2(ray.y(), ray.x()) + std::numbers::pi;
}

double elevation_of(const Vector3d& ray) {
  return std::atan2(ray.z(), std::hypot(ray.x(), ray.y()));
}

int row_of(double elevation) {
  return std::clamp(static_cast<int>((elevation + 0.5 * std::numbers::pi) / kStep_rad), 0, kRows - 1);
}

}  // namespace

DirectionMap::DirectionMap(const Scan& scan, const Vector3d& centre)
    : centre_(centre), answered_(static_cast<std::size_t>(kColumns) * kRows, 0) {
  for (const Vector3d& point : scan.points) {
    const Vector3d ray = point - centre;
    const int column = std::min(kColumns - 1, static_cast<int>(azimuth_of(ray) / kStep_rad));
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
