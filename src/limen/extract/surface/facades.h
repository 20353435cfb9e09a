// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/base/angles.h"
#include "limen/geometry/polygon.h"

namespace limen {

/// Which polygons are façades: large and vertical (Djahel, Monasse, Vallet 2021, section 3.1.1).
struct FacadeCriteria {
  double max_tilt_rad = radians(3.0);  ///< of the plane from the vertical, in (0, pi/4)
  double min_area_m2 = 5.0;            ///< inside the outer rings, openings counted as wall, >= 0
  double min_height_m = 2.0;           ///< extent along the vertical, >= 0
  double min_width_m = 1.0;            ///< extent across, >= 0

  void check() const;
};

/// Indices of the façades, largest first. `up`: unit vector against gravity, in the polygons' frame.
/// The wall's size is taken with its openings filled: a façade that is mostly glass is one too.
std::vector<int> find_facades(const std::vector<PlanarPolygon>& polygons, const Vector3d& up,
                              const FacadeCriteria& options = {});

/// How far the region of a wall reaches beyond its polygon.
struct WallOutlineOptions {
  /// Gaps narrower than this are closed: cornices, a window at the scan's edge; >= 0.
  double close_gaps_m = 0.5;
  /// Parallel pieces this near to the plane belong to the wall: plinths, bands; >= 0.
  double max_relief_m = 0.1;

  void check() const;
};

/// The region of a wall's plane that belongs to the house, in the frame of polygons[wall]: its outer rings
/// and those of the pieces in relief that it hangs together with, all holes filled and narrow gaps closed. An
/// opening is exactly a hole in the polygon, so that a test against the polygon itself would refuse every ray
/// that came in through a window.
std::vector<Polygon> wall_outline(const std::vector<PlanarPolygon>& polygons, int wall,
                                  const WallOutlineOptions& options = {});

}  // namespace limen
