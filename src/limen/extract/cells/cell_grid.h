// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "limen/extract/cells/cell_runs.h"
#include "limen/extract/cells/morton_order.h"
#include "limen/geometry/plane.h"

namespace limen {

/// The plane that the points of one cube make.
struct CellShape {
  double thickness_m = 0.0;  ///< root mean square distance to its own plane
  double spread_m = 0.0;     ///< standard deviation along its second axis
  /// Largest distance to the plane of the mean of a small cube within, of a quarter of the edge, less what
  /// noise explains: high where the cube holds a step or a bend that its thickness hides.
  double unevenness_m = 0.0;
  Vector3d mean = Vector3d::Zero();
  Vector3d normal = Vector3d::UnitZ();
  PointMoments moments;

  [[nodiscard]] Plane plane() const { return {normal, normal.dot(mean)}; }
};

/// A cube with fewer points has no shape.
constexpr std::uint32_t kLeastOfShape = 6;

/// The shape of `points`, at least kLeastOfShape positions along `sorted`'s curve, all of one cube of
/// `level`.
CellShape shape_of(const MortonOrder& sorted, std::span<const std::uint32_t> points, int level);

/// Calls use(begin, end) for each run of the places in `active` whose points lie in one cube of `level`.
template <typename Use>
void for_each_cell(const MortonOrder& sorted, std::span<const std::uint32_t> active, int level,
                   const Use& use) {
  const int shift = 3 * level;
  for (std::uint32_t begin = 0; begin < active.size();) {
    const std::uint64_t cube = sorted.codes[active[begin]] >> shift;
    std::uint32_t end = begin + 1;
    while (end < active.size() && sorted.codes[active[end]] >> shift == cube) ++end;
    use(begin, end);
    begin = end;
  }
}

/// The points of one cube that belong to no plane yet.
struct Cell {
  std::uint32_t begin = 0;  ///< into the list of active points
  std::uint32_t end = 0;
  std::int32_t region = -1;
  std::int32_t shape = -1;  ///< of the plane they make; -1: they are too few
  bool planar = false;

  [[nodiscard]] std::uint32_t count() const { return end - begin; }
};

/// Cubes of one level over the active points.
class CellGrid {
 public:
  /// `active`: positions along `sorted`'s curve, ascending. `level`: the cube's edge is cell_m * 2^level.
  CellGrid(const MortonOrder& sorted, const std::vector<std::uint32_t>& active, int level);

  [[nodiscard]] std::vector<Cell>& cells() { return cells_; }
  [[nodiscard]] const std::vector<Cell>& cells() const { return cells_; }
  /// Of a cell that has one.
  [[nodiscard]] const CellShape& shape(const Cell& cell) const {
    return shapes_[static_cast<std::size_t>(cell.shape)];
  }
  [[nodiscard]] double edge_m() const { return edge_m_; }
  /// Indices of the occupied ones of the 26 neighbours of a cell, in a fixed order.
  [[nodiscard]] CellNeighbours neighbours(std::size_t cell) const { return runs_.neighbours(cell); }

 private:
  CellRuns runs_;
  std::vector<Cell> cells_;
  std::vector<CellShape> shapes_;  ///< of the few cubes with points enough: far more have not
  double edge_m_ = 0.0;
};

}  // namespace limen
