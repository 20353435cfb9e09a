// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/geometry/thinning.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "limen/base/error.h"
#include "limen/geometry/cell_numbers.h"

namespace limen {
namespace {

/// Numbers the occupied cells of a square grid in the order of their first points; where the grid is not much
/// larger than the number of points, they are found by a plain array.
class OccupiedCells {
 public:
  static constexpr std::uint32_t kNone = CellNumbers::kNone;

  OccupiedCells(std::size_t points, std::int64_t columns, std::int64_t rows) {
    const double cells = static_cast<double>(columns) * static_cast<double>(rows);
    if (cells <= kCellsPerPoint * static_cast<double>(points)) {
      columns_ = columns;
      rows_ = rows;
      plain_.assign(static_cast<std::size_t>(columns * rows), kNone);
    } else {
      numbers_ = CellNumbers(points / 4);
    }
  }

  std::uint32_t insert(std::int32_t x, std::int32_t y) {
    if (plain_.empty()) return numbers_.insert(x, y);
    std::uint32_t& number = plain_[static_cast<std::size_t>(y * columns_ + x)];
    if (number == kNone) number = numbers_.insert(x, y);
    return number;
  }
  [[nodiscard]] std::uint32_t find(std::int32_t x, std::int32_t y) const {
    if (plain_.empty()) return numbers_.find(x, y);
    if (x < 0 || y < 0 || x >= columns_ || y >= rows_) return kNone;
    return plain_[static_cast<std::size_t>(y * columns_ + x)];
  }
  [[nodiscard]] std::size_t size() const { return numbers_.size(); }
  [[nodiscard]] std::array<std::int32_t, 2> cell(std::size_t id) const {
    return {numbers_.x(id), numbers_.y(id)};
  }

  [[nodiscard]] bool occupied(std::int32_t x, std::int32_t y) const { return find(x, y) != kNone; }

  /// True where an empty block of 3 x 3 cells lies around: smaller gaps hold no disc of alpha.
  [[nodiscard]] bool at_edge(std::size_t id) const {
    const auto [x, y] = cell(id);
    if (surrounded(x, y)) return false;
    // Any block of 3 x 3 of the 9 x 9 cells around covers exactly one of these nine.
    for (std::int32_t k = 0; k < 9; ++k) {
      const std::int32_t at_x = x + 3 * (k % 3) - 3;
      const std::int32_t at_y = y + 3 * (k / 3) - 3;
      if (!occupied(at_x, at_y) && in_empty_block(at_x, at_y)) return true;
    }
    return false;
  }

 private:
  [[nodiscard]] bool surrounded(std::int32_t x, std::int32_t y) const {
    for (std::int32_t k = 0; k < 9; ++k) {
      if (!occupied(x + k % 3 - 1, y + k / 3 - 1)) return false;
    }
    return true;
  }

  /// True where one of the nine blocks of 3 x 3 cells over this one is empty.
  [[nodiscard]] bool in_empty_block(std::int32_t x, std::int32_t y) const {
    std::array<bool, 25> full;
    for (std::int32_t k = 0; k < 25; ++k) {
      full[static_cast<std::size_t>(k)] = occupied(x + k % 5 - 2, y + k / 5 - 2);
    }
    for (std::size_t corner : {0U, 1U, 2U, 5U, 6U, 7U, 10U, 11U, 12U}) {
      bool empty = true;
      for (std::size_t k = 0; k < 9; ++k) empty = empty && !full[corner + 5 * (k / 3) + k % 3];
      if (empty) return true;
    }
    return false;
  }

  static constexpr double kCellsPerPoint = 4.0;

  std::int64_t columns_ = 0;
  std::int64_t rows_ = 0;
  std::vector<std::uint32_t> plain_;  ///< per cell of the grid; empty: the grid is too large for that
  CellNumbers numbers_;
};

/// What stays of a cell: its point nearest to the middle, or, at the edge, its extremes in eight directions.
class Representatives {
 public:
  Representatives(const std::vector<Vector2d>& points, double cell_m, const Vector2d& low,
                  const Vector2d& high)
      : points_(points),
        cell_m_(cell_m),
        origin_(low),
        table_(points.size(), cells_along(low.x(), high.x()), cells_along(low.y(), high.y())) {}

  std::vector<std::uint32_t> indices() {
    assign_cells();
    choose_cells();
    std::vector<std::uint32_t> first(roles_.size() + 1, 0);
    for (std::size_t cell = 0; cell < roles_.size(); ++cell) first[cell + 1] = first[cell] + kept_of(cell);
    std::vector<std::uint32_t> kept(first.back());
    std::vector<double> best(first.back(), -std::numeric_limits<double>::infinity());
    for (std::uint32_t i = 0; i < points_.size(); ++i) {
      const std::uint32_t cell = cell_of_point_[i];
      if (cell == OccupiedCells::kNone || roles_[cell] == Role::dropped) continue;
      offer(i, middle(cell), kept_of(cell), &kept[first[cell]], &best[first[cell]]);
    }
    std::sort(kept.begin(), kept.end());
    kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
    return kept;
  }

 private:
  enum class Role : char { dropped, inside, edge };
  static constexpr std::uint32_t kWays = 8;  ///< in which the points of a cell at the edge reach furthest

  [[nodiscard]] std::int64_t cells_along(double low, double high) const {
    return static_cast<std::int64_t>(std::floor((high - low) / cell_m_)) + 1;
  }

  void assign_cells() {
    cell_of_point_.assign(points_.size(), OccupiedCells::kNone);
    std::int32_t last_x = 0;
    std::int32_t last_y = 0;
    std::uint32_t last = OccupiedCells::kNone;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (!usable(points_[i])) continue;
      // None lies below the origin.
      const Vector2d scaled = (points_[i] - origin_) / cell_m_;
      const auto x = static_cast<std::int32_t>(scaled.x());
      const auto y = static_cast<std::int32_t>(scaled.y());
      if (last == OccupiedCells::kNone || x != last_x || y != last_y)
        last = table_.insert(last_x = x, last_y = y);
      cell_of_point_[i] = last;
    }
  }

  void choose_cells() {
    roles_.resize(table_.size());
    for (std::size_t id = 0; id < roles_.size(); ++id) {
      // A block whose middle cell is empty keeps a point of each of its other cells.
      const auto [x, y] = table_.cell(id);
      const std::int32_t middle_x = x - (x % 3 + 3) % 3 + 1;
      const std::int32_t middle_y = y - (y % 3 + 3) % 3 + 1;
      const bool stays = (x == middle_x && y == middle_y) || !table_.occupied(middle_x, middle_y);
      roles_[id] = table_.at_edge(id) ? Role::edge : stays ? Role::inside : Role::dropped;
    }
  }

  [[nodiscard]] Vector2d middle(std::uint32_t cell) const {
    const auto [x, y] = table_.cell(cell);
    return origin_ + cell_m_ * Vector2d(static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5);
  }

  /// How many points stay of a cell, some of them perhaps the same.
  [[nodiscard]] std::uint32_t kept_of(std::size_t cell) const {
    return roles_[cell] == Role::dropped ? 0 : roles_[cell] == Role::edge ? kWays : 1;
  }

  void offer(std::uint32_t i, const Vector2d& about, std::uint32_t count, std::uint32_t* kept,
             double* best) const {
    const Vector2d p = points_[i] - about;
    std::array<double, kWays> score{-p.squaredNorm()};
    if (count == kWays)
      score = {p.x(), -p.x(), p.y(), -p.y(), p.x() + p.y(), -p.x() - p.y(), p.x() - p.y(), p.y() - p.x()};
    for (std::uint32_t k = 0; k < count; ++k) {
      if (score[k] <= best[k]) continue;
      best[k] = score[k];
      kept[k] = i;
    }
  }

  const std::vector<Vector2d>& points_;
  double cell_m_;
  Vector2d origin_;
  OccupiedCells table_;
  std::vector<std::uint32_t> cell_of_point_;
  std::vector<Role> roles_;
};

}  // namespace

bool usable(const Vector2d& p) {
  constexpr double kMaxCoordinate_m = 1e12;
  return std::abs(p.x()) <= kMaxCoordinate_m && std::abs(p.y()) <= kMaxCoordinate_m;
}

std::vector<std::uint32_t> thinned(const std::vector<Vector2d>& points, double cell_m) {
  if (!(cell_m > 0.0)) throw_bad_option("cell_m", cell_m, "greater than 0");
  Vector2d low = Vector2d::Zero();
  Vector2d high = Vector2d::Zero();
  bool any = false;
  for (const Vector2d& p : points) {
    if (!usable(p)) continue;
    low = any ? low.cwiseMin(p).eval() : p;
    high = any ? high.cwiseMax(p).eval() : p;
    any = true;
  }
  if (!any) return {};
  // Cell numbers must fit their integers, whatever the extent.
  const double cell = std::max(cell_m, (high - low).maxCoeff() / 0x1.0p30);
  return Representatives(points, cell, low, high).indices();
}

}  // namespace limen
