// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "limen/model/scan.h"

namespace limen {

/// Some points of a scan, by which a copy of it is known again: in any order, and rounded as formats round.
class PointSample {
 public:
  PointSample() = default;
  explicit PointSample(const Scan& scan);

  /// The share of the sample that a scan has a point at the place of; 0 of an empty sample.
  [[nodiscard]] double share_in(const Scan& scan) const;
  /// Whether a scan has as many points, and all of the sample.
  [[nodiscard]] bool is_of(const Scan& scan) const { return scan.size() == points_ && share_in(scan) == 1.0; }

 private:
  std::size_t points_ = 0;
  std::vector<Vector3d> some_;  ///< metres, world; by x
};

/// The least of the numbers of a scan's points, by which a part of it is known again: one that was cut or
/// thinned and whose coordinates were not rounded to more than some micrometres. Ascending.
std::vector<std::uint64_t> point_marks(const Scan& scan);

/// Whether nearly all points of the scan with the marks `part` are points of the one with `whole` too.
bool is_part_of(const std::vector<std::uint64_t>& part, const std::vector<std::uint64_t>& whole);

/// What a user is told who registers a scan of so many points to itself.
std::string same_points_note(std::size_t points);
/// The same where the points of TARGET are those of SOURCE, or of one side are a part of the other's; empty
/// where both are scans of their own.
std::string same_points_note(const PointSample& source, const std::vector<std::uint64_t>& marks_of_source,
                             const Scan& target);

}  // namespace limen
