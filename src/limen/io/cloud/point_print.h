// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "limen/model/scan.h"

namespace limen {

/// What a copy of a scan's points, or a part of them, is known by again.
struct PointPrint {
  std::size_t points = 0;
  /// Their deviations along the principal axes and their mean distance from the middle, metres: the same in
  /// any order and after any motion.
  std::array<double, 4> spread_m{};
  double step_m = 0.0;  ///< that their coordinates are rounded to: a millimetre or more; 0: less
  /// The least of the numbers that the places of the points have, ascending: of a part some of the same,
  /// where it was not moved nor rounded to more than some micrometres.
  std::vector<std::uint64_t> marks;
};
PointPrint print_of(const Scan& scan);

/// Whether two scans have as many points, and the same but for a motion, in any order, and rounded.
bool same_points(const PointPrint& a, const PointPrint& b);

/// Whether nearly all points of `part` are points of `whole` too.
bool is_part_of(const PointPrint& part, const PointPrint& whole);

/// What a user reads who registers a scan of so many points to itself.
std::string same_points_note(std::size_t points);
/// The same where the points of TARGET are those of SOURCE, or of one side are a part of the other's; empty
/// where both are scans of their own.
std::string same_points_note(const PointPrint& source, const PointPrint& target);

}  // namespace limen
