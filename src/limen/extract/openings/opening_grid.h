// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "limen/extract/openings/opening_evidence.h"
#include "limen/model/scan.h"

namespace limen {

/// From every cell of a grid the way to the nearest cell of a kind, by two sweeps that pass on the nearest
/// cell so far (P.-E. Danielsson, "Euclidean distance mapping", 1980, with all eight neighbours): now and
/// then one that is hardly farther than the nearest.
class NearestCells {
 public:
  struct Way {
    std::int32_t columns = kNowhere;
    std::int32_t rows = kNowhere;

    [[nodiscard]] bool known() const { return columns < kNowhere / 2; }
    /// Of its length.
    [[nodiscard]] std::int64_t squared() const {
      return std::int64_t{columns} * columns + std::int64_t{rows} * rows;
    }
  };

  /// is_one(column, row): whether that cell is of the kind.
  template <typename IsOne>
  NearestCells(int columns, int rows, const IsOne& is_one) : columns_(columns), width_(columns + 2) {
    ways_.resize(static_cast<std::size_t>(width_) * (static_cast<std::size_t>(rows) + 2));
    for (int r = 0; r < rows; ++r) {
      for (int c = 0; c < columns; ++c) {
        if (is_one(c, r)) ways_[place(c, r)] = {0, 0};
      }
    }
    for (int r = 0; r < rows; ++r) sweep_row(r, -1);
    for (int r = rows - 1; r >= 0; --r) sweep_row(r, 1);
  }

  /// Not known where no cell is of the kind.
  [[nodiscard]] const Way& from(int column, int row) const { return ways_[place(column, row)]; }

 private:
  /// Farther than any grid reaches, steps added or not; its square fits.
  static constexpr std::int32_t kNowhere = 1 << 28;

  [[nodiscard]] std::size_t place(int column, int row) const {
    return (static_cast<std::size_t>(row) + 1) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(column) + 1;
  }

  /// What the row on the side `dr` and the neighbours in the row know. Cells around the grid know nothing.
  void sweep_row(int row, int dr) {
    const int dc = dr;
    const int first = dc < 0 ? 0 : columns_ - 1;
    for (int k = 0, c = first; k < columns_; ++k, c -= dc) {
      Best best(ways_[place(c, row)]);
      if (best.squared == 0) continue;
      for (const auto& [step_c, step_r] :
           {std::pair{dc, 0}, std::pair{dc, dr}, std::pair{0, dr}, std::pair{-dc, dr}})
        best.offer(ways_[place(c + step_c, row + step_r)], step_c, step_r);
      ways_[place(c, row)] = best.way;
    }
    for (int k = 0, c = columns_ - 1 - first; k < columns_; ++k, c += dc) {
      Best best(ways_[place(c, row)]);
      best.offer(ways_[place(c - dc, row)], -dc, 0);
      ways_[place(c, row)] = best.way;
    }
  }

  struct Best {
    Way way;
    std::int64_t squared;

    explicit Best(const Way& known) : way(known), squared(known.squared()) {}
    void offer(const Way& other, std::int32_t columns, std::int32_t rows) {
      const Way by_other{other.columns + columns, other.rows + rows};
      if (by_other.squared() >= squared) return;
      way = by_other;
      squared = by_other.squared();
    }
  };

  int columns_;
  int width_;  ///< of a row with a cell more at either end
  std::vector<Way> ways_;
};

/// In which directions a static scanner got anything back: a raster of azimuth and elevation about the z axis
/// of the scan's frame.
class DirectionMap {
 public:
  /// Knows nothing: every direction counts as answered.
  DirectionMap() = default;
  DirectionMap(const Scan& scan, const Vector3d& centre);

  [[nodiscard]] const Vector3d& centre() const { return centre_; }
  /// Nothing came back from within `radius_rad` of the direction of `x`; false near the poles of the raster.
  [[nodiscard]] bool silent(const Vector3d& x, double radius_rad) const;

 private:
  Vector3d centre_ = Vector3d::Zero();
  std::vector<char> answered_;
};

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
