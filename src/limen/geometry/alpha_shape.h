// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/geometry/polygon.h"

namespace limen {

struct AlphaShapeOptions {
  double alpha_m = 0.3;      ///< radius of the disc that must not fit between the points, > 0
  double min_part_m2 = 0.0;  ///< parts with less area (holes taken out) are dropped, >= 0
  double min_hole_m2 = 0.0;  ///< smaller holes are filled, >= 0
  bool thin = true;          ///< thin the points first: see thinning.h; far faster on dense scans

  void check() const;
};

/// The alpha shape of points of a plane (Edelsbrunner et al. 1983, regularised: no dangling edges, no lone
/// points): the union of the Delaunay triangles whose circumscribed circle has a radius of at most alpha_m.
///
/// One polygon for each part whose triangles hang together by edges, largest area first; islands inside
/// holes are parts of their own. Rings are simple: where a ring would touch itself in a point it is split
/// there, so that rings may share single points but never cross.
/// Coordinates are rounded to a grid of 10 um (coarser where the extent exceeds a kilometre). Points that are
/// not finite (or beyond 1e12 m) are ignored. Fewer than three distinct points, or all on one line: no
/// polygon.
std::vector<Polygon> alpha_shape(const std::vector<Vector2d>& points, const AlphaShapeOptions& options);

}  // namespace limen
