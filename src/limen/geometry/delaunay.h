// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace limen {

/// A point with whole coordinates, so that nothing about it is rounded.
struct GridPoint {
  std::int32_t x = 0;
  std::int32_t y = 0;

  friend bool operator==(const GridPoint&, const GridPoint&) = default;
  friend auto operator<=>(const GridPoint&, const GridPoint&) = default;
};

/// Coordinates lie within plus and minus this.
constexpr std::int32_t kMostGrid = 1 << 26;

/// A triangle of a Delaunay triangulation: its corners counter-clockwise, and the triangle across the edge
/// opposite each of them.
struct DelaunayFace {
  static constexpr std::int32_t kNone = -1;
  std::array<std::int32_t, 3> corners{};
  std::array<std::int32_t, 3> across{kNone, kNone, kNone};  ///< kNone: a face too large for the grid, or none
};

/// The faces of the Delaunay triangulation of distinct `points` whose circumscribed circle has a radius of at
/// most `most_radius` (in the points' unit, at most kMostGrid); what is larger, along the hull or in gaps, is
/// left out. Which of the triangulations of points on one circle is found is not said; points, order and
/// result are otherwise one to one.
std::vector<DelaunayFace> delaunay_faces(const std::vector<GridPoint>& points, double most_radius);

}  // namespace limen
