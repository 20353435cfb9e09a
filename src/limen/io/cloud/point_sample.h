// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
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

}  // namespace limen
