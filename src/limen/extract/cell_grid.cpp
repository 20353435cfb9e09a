// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/cell_grid.h"

#include <bit>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "limen/base/parallel.h"
#include "limen/base/random.h"

namespace limen {
namespace {

constexpr std::uint32_t kMinCellPoints = 6;

void measure(Cell& cell, const MortonOrder& sorted, const std::vector<std::uint32_t>& active) {
  for (std::uint32_t k = cell.begin; k < cell.end; ++k) cell.moments.add(sorted.points[active[k]]);
  cell.mean = cell.moments.mean();
  if (cell.count() < kMinCellPoints) return;
  Eigen::SelfAdjointEigenSolver<Matrix3d> solver;
  solver.computeDirect(cell.moments.covariance());
  const Vector3d variances = solver.eigenvalues().cwiseMax(0.0);
  const double freedoms = cell.moments.count / (cell.moments.count - 3.0);
  cell.thickness_m = std::sqrt(variances[0] * freedoms);
  cell.spread_m = std::sqrt(variances[1]);
  cell.normal = solver.eigenvectors().col(0);
}

}  // namespace

CellGrid::CellGrid(const MortonOrder& sorted, const std::vector<std::uint32_t>& active, int level)
    : edge_m_(sorted.cell_m * std::exp2(level)) {
  const int shift = 3 * level;
  for (std::uint32_t k = 0; k < active.size(); ++k) {
    const std::uint64_t code = sorted.codes[active[k]] >> shift;
    if (cells_.empty() || cells_.back().code != code) {
      cells_.emplace_back();
      cells_.back().code = code;
      cells_.back().begin = k;
    }
    cells_.back().end = k + 1;
  }
  parallel_for(cells_.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) measure(cells_[i], sorted, active);
  });
  table_.assign(std::bit_ceil(2 * cells_.size() + 1), -1);
  mask_ = table_.size() - 1;
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    std::uint64_t slot = mix64(cells_[i].code) & mask_;
    while (table_[slot] >= 0) slot = (slot + 1) & mask_;
    table_[slot] = static_cast<std::int32_t>(i);
  }
}

std::int32_t CellGrid::find(std::uint64_t code) const {
  for (std::uint64_t slot = mix64(code) & mask_; table_[slot] >= 0; slot = (slot + 1) & mask_) {
    if (cells_[static_cast<std::size_t>(table_[slot])].code == code) return table_[slot];
  }
  return -1;
}

std::vector<std::int32_t> CellGrid::neighbours(const Cell& cell) const {
  const CellIndex at = morton_decode(cell.code);
  std::vector<std::int32_t> found;
  found.reserve(26);
  for (std::uint32_t step = 0; step < 27; ++step) {
    if (step == 13) continue;
    // Unsigned wrap-around gives a code that no cell has.
    const std::int32_t neighbour =
        find(morton_encode(at.x + step % 3 - 1, at.y + step / 3 % 3 - 1, at.z + step / 9 - 1));
    if (neighbour >= 0) found.push_back(neighbour);
  }
  return found;
}

}  // namespace limen
