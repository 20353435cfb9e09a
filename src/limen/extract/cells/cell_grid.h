// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limen/extract/cells/cell_runs.h"
#include "limen/geometry/plane.h"

namespace limen {

/// The points of one cube that belong to no plane yet, and the plane they make.
struct Cell {
  std::uint32_t begin = 0;  ///< into the list of active points
  std::uint32_t end = 0;
  bool planar = false;
  std::int32_t region = -1;
  double thickness_m = 0.0;  ///< root mean square distance to its own plane
  double spread_m = 0.0;     ///< standard deviation along its second axis
  /// Largest distance to the plane of the mean of a small cube within, of a quarter of the edge, less what
  /// noise explains: high where the cube holds a step or a bend that its thickness hides.
  double unevenness_m = 0.0;
  Vector3d mean = Vector3d::Zero();
  Vector3d normal = Vector3d::UnitZ();
  PointMoments moments;

  [[nodiscard]] std::uint32_t count() const { return end - begin; }
  [[nodiscard]] Plane plane() const { return {normal, normal.dot(mean)}; }
};

/// Cubes of one level over the active points.
class CellGrid {
 public:
  /// `active`: positions along `sorted`'s curve, ascending. `level`: the cube's edge is cell_m * 2^level.
  CellGrid(const MortonOrder& sorted, const std::vector<std::uint32_t>& active, int level);

  [[nodiscard]] std::vector<Cell>& cells() { return cells_; }
  [[nodiscard]] const std::vector<Cell>& cells() const { return cells_; }
  [[nodiscard]] double edge_m() const { return edge_m_; }
  /// Indices of the occupied ones of the 26 neighbours of a cell, in a fixed order.
  [[nodiscard]] CellNeighbours neighbours(std::size_t cell) const { return runs_.neighbours(cell); }

 private:
  CellRuns runs_;
  std::vector<Cell> cells_;
  double edge_m_ = 0.0;
};

}  // namespace limen
