// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "limen/extract/cells/cell_runs.h"

namespace limen {

struct PlaneCount {
  std::int32_t plane = -1;
  double count = 0.0;
};

/// Adds to a plane's count among those from `begin` on.
inline void add_count(std::vector<PlaneCount>& counts, std::size_t begin, PlaneCount more) {
  for (std::size_t i = begin; i < counts.size(); ++i) {
    if (counts[i].plane != more.plane) continue;
    counts[i].count += more.count;
    return;
  }
  counts.push_back(more);
}

/// How many points of which planes each cube holds, in the order of their first points.
class CubeCounts {
 public:
  /// `labels[k]`: plane of the k-th point along the curve, or -1. Planes with fewer than `least` points in a
  /// cube are left out there.
  CubeCounts(const CellRuns& runs, const std::vector<std::int32_t>& labels, double least = 1.0);

  [[nodiscard]] std::span<const PlaneCount> of(std::size_t cube) const {
    return {counts_.data() + begins_[cube], begins_[cube + 1] - begins_[cube]};
  }

 private:
  std::vector<std::size_t> begins_;
  std::vector<PlaneCount> counts_;
};

}  // namespace limen
