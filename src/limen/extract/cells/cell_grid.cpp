// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/cells/cell_grid.h"

#include <array>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "limen/base/parallel.h"

namespace limen {
namespace {

constexpr std::uint32_t kMinCellPoints = 6;
constexpr double kMinChildPoints = 4.0;
constexpr int kChildLevels = 2;  // quarters of the edge: halves are met by a tilted plane through any step

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

double unevenness_of(const Cell& cell, const MortonOrder& sorted, const std::vector<std::uint32_t>& active,
                     int level) {
  struct Child {
    double count = 0.0;
    double sum = 0.0;
  };
  std::array<Child, 1U << (3 * kChildLevels)> children;
  const Plane plane = cell.plane();
  const int shift = 3 * (level - kChildLevels);
  for (std::uint32_t k = cell.begin; k < cell.end; ++k) {
    Child& child = children[(sorted.codes[active[k]] >> shift) & (children.size() - 1)];
    child.count += 1.0;
    child.sum += plane.signed_distance(sorted.points[active[k]]);
  }
  double worst = 0.0;
  for (const Child& child : children) {
    if (child.count < kMinChildPoints) continue;
    const double explained = 3.0 * cell.thickness_m / std::sqrt(child.count);
    worst = std::max(worst, std::abs(child.sum / child.count) - explained);
  }
  return worst;
}

}  // namespace

CellGrid::CellGrid(const MortonOrder& sorted, const std::vector<std::uint32_t>& active, int level)
    : runs_(sorted, active, level), cells_(runs_.size()), edge_m_(sorted.cell_m * std::exp2(level)) {
  parallel_for(cells_.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      cells_[i].begin = runs_.begin(i);
      cells_[i].end = runs_.end(i);
      measure(cells_[i], sorted, active);
      if (level >= kChildLevels && cells_[i].count() >= kMinCellPoints)
        cells_[i].unevenness_m = unevenness_of(cells_[i], sorted, active, level);
    }
  });
}

}  // namespace limen
