// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limen/base/progress.h"
#include "limen/extract/surface/facades.h"
#include "limen/geometry/polygon.h"
#include "limen/geometry/polygon_clip.h"
#include "limen/model/scan.h"

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

// Points behind a wall, by ray tracing: Djahel, Monasse, Vallet 2021, section 3.1.2; the crossings are also
// the evidence of openings of Djahel, Vallet, Monasse 2022, section 2.2.
//
// Departures from the printed text:
// - the crossing is tested against the outer ring with its holes filled: windows are the holes of the
// polygon,
//   and a test against the polygon itself fails exactly at them;
// - only crossings strictly between the scanner position and the point count, each point having its own
// centre;
// - the printed distance is the one along the ray from the crossing to the point; at grazing incidence a wall
//   that bulges by a few centimetres would pass it, so the depth behind the plane has a bound of its own;
// - a wall whose outer side is known is only crossed from there.

struct InteriorPointOptions {
  double min_beyond_m = 1.0;  ///< from the crossing to the point along the ray, >= 0 (openings: 0.1)
  double min_depth_m = 0.1;   ///< of the point behind the wall's plane, > 0
  WallOutlineOptions outline;

  void check() const;
};

/// Where the ray of a point came through a wall.
struct Crossing {
  std::uint32_t point = 0;         ///< index into the scan
  std::int32_t wall = -1;          ///< index into the polygons
  Vector2d at = Vector2d::Zero();  ///< plane coordinates of that polygon's frame
  double depth_m = 0.0;            ///< of the point behind the plane
};

/// For each point behind one of the walls `walls` (indices into `polygons`, about the scan's local origin)
/// the crossing nearest to the scanner, by ascending point index. Throws Error where the scanner's
/// position is not known.
std::vector<Crossing> find_interior_points(const Scan& scan, const std::vector<PlanarPolygon>& polygons,
                                           const std::vector<int>& walls,
                                           const InteriorPointOptions& options = {},
                                           Monitor& monitor = silent_monitor());

/// The points of the crossings, for subset().
std::vector<std::uint32_t> point_indices(const std::vector<Crossing>& crossings);

}  // namespace limen
