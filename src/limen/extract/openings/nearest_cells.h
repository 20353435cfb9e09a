// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

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

}  // namespace limen
