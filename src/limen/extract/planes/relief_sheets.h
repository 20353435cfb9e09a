// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limen/extract/planes/join_pieces.h"
#include "limen/extract/planes/plane_labels.h"
#include "limen/model/scan.h"

namespace limen {

struct SheetOptions {
  double threshold_m = 0.008;  ///< farthest a point may lie from its sheet
  int min_inliers = 200;       ///< smallest sheet, points
};

/// Sheets of the relief of walls: frames, mouldings, sides of openings, each in many narrow strips all along
/// a wall, which a mobile scan meets with a row of points here and there. No cube holds enough of one to show
/// a plane; all of them together do, for they are parallel to the wall, or level, or upright across it: of
/// the points near a wall that belong to no plane, the offsets along each of these three directions are
/// counted, and where many more lie than on either side of it there is a sheet. Within it, points stay where
/// they are denser than beside it.
/// `tails`: per point the plane whose noise may have brought it there, or -1, or empty: such a point tells of
/// no sheet parallel to that plane.
std::vector<PlanePiece> relief_sheets(const Scan& scan, const PlaneLabels& planes, const Vector3d& anchor,
                                      const SheetOptions& options,
                                      const std::vector<std::int32_t>& tails = {});

}  // namespace limen
