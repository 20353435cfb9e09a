// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "limen/geometry/segment.h"
#include "limen/model/features.h"

namespace limen {

/// An opening as four edges in the coordinates of its wall, metres: bottom (v), right (u), top (v), left (u),
/// in the order of Opening's edges.
struct WallRectangle {
  int opening = -1;  ///< index into Features::openings
  std::array<double, 4> edge = {0.0, 0.0, 0.0, 0.0};
  std::array<double, 4> sigma_m = {1.0, 1.0, 1.0, 1.0};  ///< 1 or more: the edge was not seen

  [[nodiscard]] bool seen(std::size_t k) const { return sigma_m[k] < 1.0; }
  [[nodiscard]] double width() const { return edge[1] - edge[3]; }
  [[nodiscard]] double height() const { return edge[2] - edge[0]; }
};

/// A wall with openings: as a scanner that is before it sees it, u points right, v up, u x v towards it.
struct WallWithOpenings {
  PlaneFrame frame;  ///< origin in the wall
  int facade = -1;   ///< index into Features::planes of its largest plane, or -1
  std::vector<WallRectangle> rectangles;

  [[nodiscard]] Vector3d normal() const { return frame.u.cross(frame.v); }
};

/// The openings of a scan by wall, in the order of their first opening. An opening without a side that was
/// seen, or in a plane that is not a wall, is left out. `up`: the vertical, a unit vector, where it is known;
/// else the openings' own upper side.
std::vector<WallWithOpenings> walls_with_openings(const Features& features,
                                                  const std::optional<Vector3d>& up = {});

/// The rectangle as somebody on the other side of the wall sees it: left and right change places.
WallRectangle seen_from_behind(const WallRectangle& rectangle);

/// The seen edges of a wall's openings as segments in space.
std::vector<Segment> seen_edges(const WallWithOpenings& wall);
/// Edge k of a rectangle as a segment in space: bottom and top to the right, left and right upwards.
Segment edge_segment(const WallWithOpenings& wall, const WallRectangle& rectangle, std::size_t k);

}  // namespace limen
