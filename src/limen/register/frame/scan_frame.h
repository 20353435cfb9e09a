// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/base/progress.h"
#include "limen/model/method.h"
#include "limen/model/scan.h"

namespace limen {

/// A frame that a scan's data fix, in which all geometry is done: z against gravity as far as the data tell,
/// x along the normals of the most walls, 0,0,0 at a corner of the extent. The same scan, moved, turned or
/// with its points in another order, has the same frame about its points.
struct ScanFrame {
  Matrix3d frame_from_scan = Matrix3d::Identity();  ///< rotation: x_in_frame = it * (x - corner)
  Vector3d corner = Vector3d::Zero();               ///< 0,0,0 of the frame, about the scan's local origin
  bool upright = false;                             ///< z points up
  bool surely_upright = false;                      ///< so clearly that no other way need be tried
  ScannerPlace place;                               ///< about the scan's local origin
  double rounding_m = 0.0;  ///< of a plane along an axis, one standard deviation: coordinates may be coarse
};

/// Up is, of the main directions of the large planes, the one with most evidence: a tripod scanner measures
/// nothing straight below itself and is nearer to the floor than to the ceiling; walls and floors lie
/// along and across it; a vehicle has the ground 1 to 5 m under its path; and, unless `gravity` is unknown, z
/// of the file is up more often than not. Costs a look at part of the points.
ScanFrame find_scan_frame(const Scan& scan, Gravity gravity, Monitor& monitor = silent_monitor());

}  // namespace limen
