// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/prepare/open_sky.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <unordered_map>
#include <utility>
#include <vector>

#include "limen/base/angles.h"

namespace limen {
namespace {

constexpr std::size_t kLooks = 200'000;       // points that are looked at, about
constexpr double kNearM = 0.3;                // the scanner's own stand
constexpr double kPerTurn = 36.0;             // directions
constexpr double kWayM = 2.0;                 // of a path, in one piece
constexpr std::size_t kSeenInDirection = 20;  // points: with fewer a direction does not count
constexpr std::size_t kLeastDirections = 12;
constexpr double kTopShare = 0.95;  // of the directions reach no higher than the field of view
constexpr double kBelowDeg = 10.0;
constexpr double kOutside = 0.32;  // between what was found of rooms and of streets

/// What is seen in one direction from one piece of the way.
struct Column {
  std::size_t points = 0;
  std::array<double, 3> highest = {-1.0, -1.0, -1.0};  // sines of elevations, descending

  /// The third highest: a stray point or two do not count.
  [[nodiscard]] double top() const { return highest.back(); }
  void add(double sine) {
    ++points;
    for (double& one : highest) {
      if (sine > one) std::swap(sine, one);
    }
  }
};

std::uint64_t direction_of(const Vector3d& centre, const Vector3d& ray) {
  const auto piece = [](double along) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(along / kWayM))) & 0xffffff;
  };
  const double turn = std::atan2(ray.y(), ray.x()) / (2.0 * std::numbers::pi) + 0.5;
  const auto side = static_cast<std::uint64_t>(std::min(kPerTurn - 1.0, std::floor(kPerTurn * turn)));
  return side << 48 | piece(centre.x()) << 24 | piece(centre.y());
}

}  // namespace

double open_sky_share(const Scan& scan) {
  std::unordered_map<std::uint64_t, Column> columns;
  const std::size_t step = std::max<std::size_t>(1, scan.size() / kLooks);
  for (std::size_t i = 0; i < scan.size(); i += step) {
    const Vector3d ray = scan.points[i] - scan.centre(i);
    const double range = ray.norm();
    if (range > kNearM) columns[direction_of(scan.centre(i), ray)].add(ray.z() / range);
  }
  std::vector<double> heights;  // degrees
  for (const auto& [direction, column] : columns) {
    if (column.points >= kSeenInDirection) heights.push_back(degrees(std::asin(column.top())));
  }
  if (heights.size() < kLeastDirections) return 0.0;
  std::sort(heights.begin(), heights.end());
  const double top = heights[static_cast<std::size_t>(kTopShare * static_cast<double>(heights.size() - 1))];
  const auto open = std::lower_bound(heights.begin(), heights.end(), top - kBelowDeg) - heights.begin();
  return static_cast<double>(open) / static_cast<double>(heights.size());
}

bool taken_outside(const Scan& scan) {
  return scan.level && scan.mobile() && open_sky_share(scan) > kOutside;
}

}  // namespace limen
