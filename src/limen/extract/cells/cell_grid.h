// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limen/extract/cells/cell_runs.h"
#include "limen/extract/cells/cell_shape.h"

namespace limen {

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
