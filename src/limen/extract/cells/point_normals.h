// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limen/extract/cells/morton_order.h"

namespace limen {

/// Which way the surface faces at each point, from the points of its cube: the smallest cube, from
/// `finest_m` up to `coarsest_m`, with enough points. Where these make no plane (an edge, clutter) or are too
/// few, it is not known.
class PointNormals {
 public:
  /// `max_thickness_m`: root mean square distance of the points of a cube to its plane.
  PointNormals(const MortonOrder& sorted, double max_thickness_m, double finest_m = 0.04,
               double coarsest_m = 0.16);

  /// The unit normal, sign arbitrary, at a position along the curve; null: not known.
  [[nodiscard]] const Vector3d* at(std::uint32_t position) const {
    const std::int32_t i = of_point_[position];
    return i < 0 ? nullptr : &normals_[static_cast<std::size_t>(i)];
  }
  /// The points around the position are many, but make no plane.
  [[nodiscard]] bool rough(std::uint32_t position) const { return of_point_[position] == kRough; }

 private:
  static constexpr std::int32_t kSparse = -1;
  static constexpr std::int32_t kRough = -2;

  std::vector<Vector3d> normals_;
  std::vector<std::int32_t> of_point_;
};

}  // namespace limen
