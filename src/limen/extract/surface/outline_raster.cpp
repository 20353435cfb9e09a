// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/surface/outline_raster.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "limen/base/error.h"

namespace limen {
namespace {

constexpr double kMostCells = 4.0e6;

}  // namespace

OutlineRaster::OutlineRaster(std::vector<Polygon> polygons, double cell_m)
    : polygons_(std::move(polygons)), box_(box_of(polygons_)), cell_m_(cell_m) {
  if (!(cell_m > 0.0)) throw_bad_option("cell_m", cell_m, "greater than 0");
  if (box_.empty()) return;
  const Vector2d size = box_.high - box_.low;
  cell_m_ = std::max({cell_m, std::sqrt(size.x() * size.y() / kMostCells), size.maxCoeff() / kMostCells});
  columns_ = static_cast<std::size_t>(size.x() / cell_m_) + 1;
  rows_ = static_cast<std::size_t>(size.y() / cell_m_) + 1;
  cells_.assign(columns_ * rows_, Cell::outside);
  for (const Polygon& polygon : polygons_) {
    const Ring& ring = polygon.outer;
    for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) cut_by(ring[j], ring[i]);
  }
  fill_rows();
}

std::size_t OutlineRaster::column(double x) const {
  return static_cast<std::size_t>(
      std::clamp((x - box_.low.x()) / cell_m_, 0.0, static_cast<double>(columns_ - 1)));
}

std::size_t OutlineRaster::row(double y) const {
  return static_cast<std::size_t>(
      std::clamp((y - box_.low.y()) / cell_m_, 0.0, static_cast<double>(rows_ - 1)));
}

/// Marks the cells that the edge passes, row by row; a little too many, so that rounding does no harm.
void OutlineRaster::cut_by(const Vector2d& a, const Vector2d& b) {
  const Vector2d& low = a.y() < b.y() ? a : b;
  const Vector2d& high = a.y() < b.y() ? b : a;
  const double slack = 1e-6 * cell_m_;
  for (std::size_t r = row(low.y() - slack); r <= row(high.y() + slack); ++r) {
    const double y0 = box_.low.y() + static_cast<double>(r) * cell_m_ - slack;
    const auto x_at = [&](double y) {
      const double t = high.y() > low.y() ? (y - low.y()) / (high.y() - low.y()) : 0.0;
      return low.x() + std::clamp(t, 0.0, 1.0) * (high.x() - low.x());
    };
    double x0 = x_at(y0);
    double x1 = high.y() > low.y() ? x_at(y0 + cell_m_ + 2.0 * slack) : high.x();
    if (x0 > x1) std::swap(x0, x1);
    for (std::size_t c = column(x0 - slack); c <= column(x1 + slack); ++c)
      cells_[r * columns_ + c] = Cell::cut;
  }
}

/// Between two cut cells of a row nothing changes: one exact test for each such run.
void OutlineRaster::fill_rows() {
  for (std::size_t r = 0; r < rows_; ++r) {
    Cell state = Cell::cut;
    for (std::size_t c = 0; c < columns_; ++c) {
      Cell& cell = cells_[r * columns_ + c];
      if (cell == Cell::cut) {
        state = Cell::cut;
        continue;
      }
      if (state == Cell::cut) {
        const Vector2d middle =
            box_.low + cell_m_ * Vector2d(static_cast<double>(c) + 0.5, static_cast<double>(r) + 0.5);
        state = contains_exactly(middle) ? Cell::inside : Cell::outside;
      }
      cell = state;
    }
  }
}

bool OutlineRaster::contains_exactly(const Vector2d& p) const {
  return std::any_of(polygons_.begin(), polygons_.end(),
                     [&](const Polygon& polygon) { return limen::contains(polygon.outer, p); });
}

bool OutlineRaster::contains(const Vector2d& p) const {
  if (cells_.empty() || !box_.contains(p)) return false;
  const Cell cell = cells_[row(p.y()) * columns_ + column(p.x())];
  return cell == Cell::cut ? contains_exactly(p) : cell == Cell::inside;
}

}  // namespace limen
