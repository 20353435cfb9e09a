// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "limen/model/scan.h"

namespace limen {

/// A scan in the order of its lines, with the links between true neighbours: the previous and the next echo
/// of the line, and the nearest echo of the line before and of the line after.
///
/// A link is cut where the distance exceeds `max_jump` times the local spacing in that direction (the smaller
/// of the distances on either side, of both ends): an edge of depth, or a gap wider than the sampling.
class ScanGrid {
 public:
  static constexpr std::int32_t kNone = -1;
  enum Link : std::size_t { previous, next, line_before, line_after };

  /// `scan` must have a topology and outlive the grid. max_jump > 1.
  ScanGrid(const Scan& scan, double max_jump);

  [[nodiscard]] std::size_t size() const { return links_.size(); }
  /// All by place in the order of lines.
  [[nodiscard]] const Vector3d& point(std::size_t at) const {
    return sorted_.empty() ? scan_->points[at] : sorted_[at];
  }
  [[nodiscard]] const std::array<std::int32_t, 4>& links(std::size_t at) const { return links_[at]; }
  /// Rank of the line among those that have points.
  [[nodiscard]] std::int32_t line(std::size_t at) const { return line_[at]; }
  /// Index of the point in the scan.
  [[nodiscard]] std::size_t scan_index(std::size_t at) const { return order_.empty() ? at : order_[at]; }

 private:
  void sort_lines();
  void link_lines();
  void link_within(std::size_t line);
  void link_across(std::size_t line, std::size_t other, Link link);
  void cut_jumps(double max_jump);
  [[nodiscard]] std::size_t nearest_in(std::size_t at, std::size_t hint, std::size_t begin,
                                       std::size_t end) const;
  [[nodiscard]] std::int32_t index(std::size_t at) const { return scan_->topology.index[scan_index(at)]; }
  [[nodiscard]] float gap(std::size_t at, Link link) const;

  const Scan* scan_;
  std::vector<std::uint32_t> order_;  ///< empty: the scan is in order already
  std::vector<Vector3d> sorted_;      ///< empty: as in the scan
  std::vector<std::size_t> begins_;   ///< first place of each line, and the size
  std::vector<std::int32_t> line_;
  std::vector<std::array<std::int32_t, 4>> links_;
};

/// One standard deviation, metres, of echoes along the surface's normal: the middle of the neighbours of the
/// same line against the middle of those of the lines beside it, so that jitter from line to line counts too.
/// From the median over the scan; 0 where too few echoes have all four neighbours.
double surface_noise(const ScanGrid& grid);

}  // namespace limen
