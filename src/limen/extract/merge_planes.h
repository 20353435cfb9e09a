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
/// `max_rms_m` (root mean square) from the plane fitted to both, nor the piece than 1.6 times that from the
/// plane as it was. Moments about one anchor.
MergedPieces merge_planes(const std::vector<PointMoments>& pieces, double max_angle_rad, double max_rms_m);

}  // namespace limen
