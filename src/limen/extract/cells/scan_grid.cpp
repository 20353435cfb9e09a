// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/cells/scan_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "limen/base/drawn_steps.h"
#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/base/ranked.h"

namespace limen {
namespace {

constexpr std::size_t kLinesPerPiece = 16;
constexpr std::size_t kPointsPerPiece = 65536;
constexpr std::int32_t kMaxLineGap = 3;

bool in_order(const ScanTopology& topology) {
  for (std::size_t i = 1; i < topology.line.size(); ++i) {
    if (topology.line[i] < topology.line[i - 1]) return false;
    if (topology.line[i] == topology.line[i - 1] && topology.index[i] < topology.index[i - 1]) return false;
  }
  return true;
}

/// Points by line, then by index, then as they are. Counts lines where their numbers are dense, as they are.
std::vector<std::uint32_t> order_of(const ScanTopology& topology) {
  const std::size_t n = topology.line.size();
  std::vector<std::uint32_t> order(n);
  const auto extremes = std::minmax_element(topology.line.begin(), topology.line.end());
  const std::int64_t first_line = *extremes.first;
  const auto range = static_cast<std::size_t>(static_cast<std::int64_t>(*extremes.second) - first_line) + 1;
  const auto before = [&](std::uint32_t a, std::uint32_t b) {
    return topology.line[a] != topology.line[b] ? topology.line[a] < topology.line[b]
                                                : topology.index[a] < topology.index[b];
  };
  if (range > 4 * n + 1024) {
    std::iota(order.begin(), order.end(), 0U);
    std::stable_sort(order.begin(), order.end(), before);
    return order;
  }
  std::vector<std::uint32_t> begins(range + 1, 0);
  const auto rank = [&](std::size_t i) { return static_cast<std::size_t>(topology.line[i] - first_line); };
  for (std::size_t i = 0; i < n; ++i) ++begins[rank(i) + 1];
  std::partial_sum(begins.begin(), begins.end(), begins.begin());
  std::vector<std::uint32_t> place(begins.begin(), begins.end() - 1);
  for (std::size_t i = 0; i < n; ++i) order[place[rank(i)]++] = static_cast<std::uint32_t>(i);
  parallel_for(range, kLinesPerPiece, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      const auto begin = order.begin() + begins[k];
      const auto end = order.begin() + begins[k + 1];
      if (!std::is_sorted(begin, end, before)) std::stable_sort(begin, end, before);
    }
  });
  return order;
}

}  // namespace

ScanGrid::ScanGrid(const Scan& scan, double max_jump) : scan_(&scan) {
  if (!scan.topology.known()) {
    throw Error("the scan lines are not known", scan.name, "use the detector for unorganised clouds");
  }
  if (!(max_jump > 1.0)) throw_bad_option("max_jump", max_jump, "greater than 1");
  sort_lines();
  link_lines();
  cut_jumps(max_jump);
}

void ScanGrid::sort_lines() {
  const std::size_t n = scan_->size();
  if (!in_order(scan_->topology)) {
    order_ = order_of(scan_->topology);
    sorted_.resize(n);
    parallel_for(n, kPointsPerPiece, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) sorted_[k] = scan_->points[order_[k]];
    });
  }
  line_.resize(n);
  for (std::size_t k = 0; k < n; ++k) {
    if (k == 0 || scan_->topology.line[scan_index(k)] != scan_->topology.line[scan_index(k - 1)]) {
      begins_.push_back(k);
    }
    line_[k] = static_cast<std::int32_t>(begins_.size()) - 1;
  }
  begins_.push_back(n);
}

void ScanGrid::link_lines() {
  links_.assign(scan_->size(), {kNone, kNone, kNone, kNone});
  const std::size_t lines = begins_.size() - 1;
  const auto number = [&](std::size_t line) { return scan_->topology.line[scan_index(begins_[line])]; };
  parallel_for(lines, kLinesPerPiece, [&](std::size_t first, std::size_t last) {
    for (std::size_t line = first; line < last; ++line) {
      link_within(line);
      if (line > 0 && number(line) - number(line - 1) <= kMaxLineGap)
        link_across(line, line - 1, line_before);
      if (line + 1 < lines && number(line + 1) - number(line) <= kMaxLineGap)
        link_across(line, line + 1, line_after);
    }
  });
}

void ScanGrid::link_within(std::size_t line) {
  for (std::size_t k = begins_[line]; k + 1 < begins_[line + 1]; ++k) {
    links_[k][next] = static_cast<std::int32_t>(k + 1);
    links_[k + 1][previous] = static_cast<std::int32_t>(k);
  }
}

/// Both lines are sorted by index: one walk along the two.
void ScanGrid::link_across(std::size_t line, std::size_t other, Link link) {
  const std::size_t end = begins_[other + 1];
  std::size_t hint = begins_[other];
  for (std::size_t k = begins_[line]; k < begins_[line + 1]; ++k) {
    while (hint < end && index(hint) < index(k)) ++hint;
    links_[k][link] = static_cast<std::int32_t>(nearest_in(k, hint, begins_[other], end));
  }
}

/// The nearest of the places around `hint`: several echoes share a pulse, and pulses may be off by one.
std::size_t ScanGrid::nearest_in(std::size_t at, std::size_t hint, std::size_t begin, std::size_t end) const {
  const std::size_t first = hint >= begin + 2 ? hint - 2 : begin;
  std::size_t best = first;
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t k = first; k < std::min(end, hint + 3); ++k) {
    const double distance = (point(k) - point(at)).squaredNorm();
    if (distance >= smallest) continue;
    smallest = distance;
    best = k;
  }
  return best;
}

float ScanGrid::gap(std::size_t at, Link link) const {
  const std::int32_t other = links_[at][link];
  if (other == kNone) return std::numeric_limits<float>::infinity();
  return static_cast<float>((point(static_cast<std::size_t>(other)) - point(at)).norm());
}

void ScanGrid::cut_jumps(double max_jump) {
  const std::size_t n = size();
  std::vector<std::array<float, 2>> spacing(n);  // along the line, across the lines
  parallel_for(n, kPointsPerPiece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      spacing[k] = {std::min(gap(k, previous), gap(k, next)),
                    std::min(gap(k, line_before), gap(k, line_after))};
    }
  });
  const auto factor = static_cast<float>(max_jump);
  parallel_for(n, kPointsPerPiece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      for (const Link link : {previous, next, line_before, line_after}) {
        const std::int32_t other = links_[k][link];
        if (other == kNone) continue;
        const std::size_t across = link < line_before ? 0 : 1;
        const float local = std::max(spacing[k][across], spacing[static_cast<std::size_t>(other)][across]);
        if (gap(k, link) > factor * local) links_[k][link] = kNone;
      }
    }
  });
}

double surface_noise(const ScanGrid& grid) {
  std::vector<double> offsets;
  for_drawn_steps(grid.size(), 200000, [&](std::size_t at) {
    const auto& links = grid.links(at);
    if (std::count(links.begin(), links.end(), ScanGrid::kNone) > 0) return;
    const auto neighbour = [&](ScanGrid::Link link) -> const Vector3d& {
      return grid.point(static_cast<std::size_t>(links[link]));
    };
    const Vector3d along = neighbour(ScanGrid::next) - neighbour(ScanGrid::previous);
    const Vector3d across = neighbour(ScanGrid::line_after) - neighbour(ScanGrid::line_before);
    const Vector3d normal = along.cross(across);
    if (normal.norm() < 0.3 * along.norm() * across.norm() || normal.norm() < 1e-9) return;
    const Vector3d of_line = neighbour(ScanGrid::next) + neighbour(ScanGrid::previous);
    const Vector3d of_others = neighbour(ScanGrid::line_after) + neighbour(ScanGrid::line_before);
    // Half the sum of four independent echoes, two of them negative: the noise of one.
    offsets.push_back(0.5 * std::abs(normal.normalized().dot(of_line - of_others)));
  });
  if (offsets.size() < 20) return 0.0;
  constexpr double kMedianOfNormal = 0.6745;
  return median(offsets) / kMedianOfNormal;
}

}  // namespace limen
