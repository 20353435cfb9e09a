// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "limen/geometry/cell_key.h"

namespace limen {

/// Points that keep their distance, in cubes as wide as that: only neighbouring cubes have to be asked.
class PointsApart {
 public:
  explicit PointsApart(double spacing_m) : spacing_m_(spacing_m) {}

  /// Whether `x` is far enough from all others; then it is kept.
  bool add(const Vector3d& x) {
    const Vector3d cell = cell_of(x, spacing_m_);
    // Its own cube first: of many points late ones mostly end there.
    if (taken(cell_key(cell), x)) return false;
    for (int k = 0; k < 27; ++k) {
      if (k != 13 && taken(cell_key(cell + way_to_cell(k)), x)) return false;
    }
    const auto [place, fresh] = last_.try_emplace(cell_key(cell), points_.size());
    before_.push_back(fresh ? kNone : place->second);
    place->second = points_.size();
    points_.push_back(x);
    return true;
  }

  [[nodiscard]] std::vector<Vector3d>& points() { return points_; }

 private:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  /// Whether a point of that cube is too near.
  [[nodiscard]] bool taken(std::int64_t key, const Vector3d& x) const {
    const auto found = last_.find(key);
    if (found == last_.end()) return false;
    for (std::size_t i = found->second; i != kNone; i = before_[i]) {
      if ((points_[i] - x).norm() < spacing_m_) return true;
    }
    return false;
  }

  double spacing_m_;
  std::vector<Vector3d> points_;
  std::vector<std::size_t> before_;                     // of each point: the one before it in its cube
  std::unordered_map<std::int64_t, std::size_t> last_;  // of each cube: its last point
};

}  // namespace limen
