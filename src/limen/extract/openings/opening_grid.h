// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limen/extract/openings/direction_map.h"
#include "limen/extract/openings/opening_evidence.h"

namespace limen {

/// What a wall looks like, cell by cell: each cell is what the sample nearest to it says, where one is near
/// compared with the distance between samples there. Scan lines may be far apart: what lies between two
/// samples of one kind is of that kind.
class OpeningGrid {
 public:
  enum class Cell : std::uint8_t {
    unknown,
    wall,
    open,
    cover,
    silent  ///< no ray came back from this direction, as from the sky behind a pane
  };

  explicit OpeningGrid(const WallEvidence& evidence, const DirectionMap& directions = {});

  [[nodiscard]] const Box2& box() const { return box_; }
  [[nodiscard]] double cell_m() const { return cell_m_; }
  [[nodiscard]] int columns() const { return columns_; }
  [[nodiscard]] int rows() const { return rows_; }
  [[nodiscard]] int column(double u) const;  ///< of a place, within the grid or beyond
  [[nodiscard]] int row(double v) const;
  /// Unknown beyond the grid.
  [[nodiscard]] Cell at(int column, int row) const;
  [[nodiscard]] bool passes(int column, int row) const {
    return at(column, row) == Cell::open || at(column, row) == Cell::silent;
  }
  /// Middle of a cell in the wall's frame.
  [[nodiscard]] Vector2d middle(int column, int row) const {
    return box_.low + cell_m_ * Vector2d(column + 0.5, row + 0.5);
  }
  /// Indices of the samples in a box, in a fixed order.
  [[nodiscard]] std::vector<std::uint32_t> samples_in(const Box2& box) const;
  /// Typical distance between samples about a place, metres.
  [[nodiscard]] double spacing_m(const Vector2d& at) const;

  /// Boxes of the connected regions of `kind` (open: and silent) whose core, `neck_m` within them, hangs
  /// together.
  [[nodiscard]] std::vector<Box2> regions(Cell kind, double neck_m) const;

 private:
  void count_samples(const WallEvidence& evidence);
  void set_spacing();
  void spread();
  void mark_silent(const OpeningWall& wall, const DirectionMap& directions);
  [[nodiscard]] std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column);
  }
  [[nodiscard]] std::size_t tile(int column, int row) const;
  [[nodiscard]] std::vector<std::uint16_t> steps_within(Cell kind) const;

  const std::vector<WallSample>* samples_;
  Box2 box_;
  double cell_m_ = 0.05;
  int columns_ = 0;
  int rows_ = 0;
  std::vector<Cell> cells_;
  std::vector<std::uint32_t> begin_;  // of each cell's samples in order_
  std::vector<std::uint32_t> order_;
  int tile_cells_ = 1;
  int tile_columns_ = 0;
  std::vector<float> tile_spacing_m_;
};

}  // namespace limen
