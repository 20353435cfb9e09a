// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "limen/deviation/deviation.h"

namespace limen {

/// Signed distances of any number of points, counted by tenths of a millimetre: memory goes with their
/// spread, and figures are good to a twentieth.
class DistanceCounts {
 public:
  /// Not-a-number and what is farther than a metre are not counted.
  void add(double distance_m);
  /// Fills points, median, mean, sigma, 95 % and class.
  void describe(ElementDeviation& it) const;
  [[nodiscard]] std::size_t points() const { return points_; }

 private:
  std::int32_t first_ = 0;  ///< bin of counts_[0]
  std::vector<std::uint64_t> counts_;
  std::size_t points_ = 0;
  double sum_ = 0.0;
  double squares_ = 0.0;

  std::uint64_t& at(std::int32_t bin);
};

}  // namespace limen
