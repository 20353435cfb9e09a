// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limen/geometry/plane.h"

namespace limen {

/// Root mean square distance, metres, of the points behind `moments` to `plane`, both about one anchor.
double rms_about(const PointMoments& moments, const Plane& plane);

/// Pieces of planes made one where they continue each other.
struct MergedPieces {
  std::vector<PointMoments> planes;  ///< in the order of their largest pieces
  std::vector<std::int32_t> target;  ///< per piece: index into planes; -1: fewer than 3 points
};

/// Each piece, largest first, joins the first plane within `max_angle_rad` such that neither is further than
/// `max_rms_m` (root mean square) from the plane fitted to both. A slight turn of that plane would hide a
/// step between pieces that lie apart: the piece must also be within 1.6 times that of the plane as it was,
/// or 4 times where both are of the size of a wall (1 m^2, 0.5 m wide), which may bulge. Moments about one
/// anchor.
MergedPieces merge_planes(const std::vector<PointMoments>& pieces, double max_angle_rad, double max_rms_m);

}  // namespace limen
