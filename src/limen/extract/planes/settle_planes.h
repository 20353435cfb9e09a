// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "limen/extract/cells/cell_runs.h"
#include "limen/extract/cells/point_normals.h"
#include "limen/geometry/plane.h"

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

struct SettleOptions {
  double threshold_m = 0.01;  ///< farthest a point may lie from its plane
  double cell_m = 0.08;       ///< a point may join the planes of its cube and of the cubes around it
};

/// The cubes in which points choose among planes, with their neighbours: made once for several settlings.
class SettleGrid {
 public:
  SettleGrid(const MortonOrder& sorted, double cell_m);

  [[nodiscard]] const CellRuns& runs() const { return runs_; }
  /// Indices of the occupied cubes around cube i.
  [[nodiscard]] std::span<const std::int32_t> around(std::size_t i) const {
    return {neighbours_.data() + begins_[i], begins_[i + 1] - begins_[i]};
  }

 private:
  CellRuns runs_;
  std::vector<std::size_t> begins_;
  std::vector<std::int32_t> neighbours_;
};

/// Who settles: points along the curve, the way the surface faces there, and the cubes.
struct SettleScene {
  const MortonOrder& sorted;
  const PointNormals& normals;
  const SettleGrid& grid;
};

/// Every point goes to the nearest plane around it that the surface there faces along with; a point that has
/// none of these goes free. `labels[k]` is the plane of the k-th point along the curve, or -1; `sums` those
/// of the planes' points, about the curve's anchor. Cubes of few points (far from the scanner) keep their
/// labels.
std::vector<std::int32_t> settled(const SettleScene& scene, const std::vector<std::int32_t>& labels,
                                  const std::vector<PointMoments>& sums, const SettleOptions& options);

/// Of each plane's points the share that larger planes around would take: near 1 for a plane that cuts
/// through the edges of others.
std::vector<double> explained_shares(const SettleScene& scene, const std::vector<std::int32_t>& labels,
                                     const std::vector<PointMoments>& sums, const SettleOptions& options);

}  // namespace limen
