// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limen/geometry/polygon_clip.h"

namespace limen {

/// Point-in-outline tests in constant time: a raster of cells that are wholly inside, wholly outside, or cut
/// by a ring; only in the last does the exact test run. The answers are those of `contains`.
class OutlineRaster {
 public:
  /// The outer rings of `polygons` (holes are ignored), which must not overlap.
  explicit OutlineRaster(std::vector<Polygon> polygons, double cell_m = 0.05);

  [[nodiscard]] bool contains(const Vector2d& p) const;
  [[nodiscard]] const Box2& box() const { return box_; }
  [[nodiscard]] const std::vector<Polygon>& polygons() const { return polygons_; }

 private:
  enum class Cell : std::uint8_t { outside, inside, cut };

  void cut_by(const Vector2d& a, const Vector2d& b);
  void fill_rows();
  [[nodiscard]] bool contains_exactly(const Vector2d& p) const;
  [[nodiscard]] std::size_t column(double x) const;
  [[nodiscard]] std::size_t row(double y) const;

  std::vector<Polygon> polygons_;
  Box2 box_;
  double cell_m_;
  std::size_t columns_ = 0;
  std::size_t rows_ = 0;
  std::vector<Cell> cells_;
};

}  // namespace limen
