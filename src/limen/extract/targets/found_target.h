// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "limen/geometry/rigid.h"

namespace limen {

/// Which targets are looked for in static scans; lengths in metres, 0: none of that kind.
struct TargetOptions {
  double sphere_radius_m = 0.0;
  double board_side_m = 0.0;  ///< of a board of two dark and two bright quadrants

  [[nodiscard]] bool any() const { return sphere_radius_m > 0.0 || board_side_m > 0.0; }
  /// Throws Error for a size that no target has.
  void check() const;
};

enum class TargetKind : std::uint8_t { sphere, board };

inline const char* to_string(TargetKind kind) {
  return kind == TargetKind::sphere ? "sphere" : "board";
}

/// A target in a scan.
struct FoundTarget {
  TargetKind kind = TargetKind::sphere;
  Vector3d centre = Vector3d::Zero();  ///< about the scan's local origin
  double sigma_m = 0.0;                ///< along the axis in which the centre is known worst
  std::size_t points = 0;              ///< that the centre follows from
};

/// A centre that is known worse than this is of no use: the scans' own surface fixes them as well. An edge
/// that lies anywhere between rows of points 15 mm apart is known to 4.3 mm.
inline constexpr double kMostTargetSigmaM = 0.0045;
/// What no residual shows of a target and its scanner: how round, how flat, how well mounted.
inline constexpr double kTargetMakeM = 0.0003;

}  // namespace limen
