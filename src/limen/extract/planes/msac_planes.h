// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "limen/base/progress.h"
#include "limen/extract/planes/plane_labels.h"
#include "limen/model/scan.h"

// Planes of an unorganised cloud by MSAC over all of it: Djahel, Monasse, Vallet 2021, section 2.2. Three
// points drawn make a plane, the plane that the most points bear out is taken with its inliers, and so on
// with what is left. The baseline that the default detector is measured against (grow_planes.h).
//
// Departures:
// - the score is the unitless one of 2022, equation 2, higher is better (equations 1 and 2 are costs);
// - the number of trials follows from the inlier ratio and a confidence, up to a limit;
// - the second and third point come from around the first: a plane of one point in a hundred is hit by one in
//   a million of the printed samples;
// - the plane is refitted to its inliers by least squares, and these are taken anew.

namespace limen {

struct MsacPlaneOptions {
  double inlier_threshold_m = 0.02;  ///< > 0
  int min_inliers = 200;             ///< smallest plane, points, >= 3
  std::uint64_t seed = 1;
};

/// Planes, most inliers first, and the plane of each point. A plane takes every free point within the
/// threshold however far it lies along the plane, as published.
PlaneLabels msac_planes(const Scan& scan, const MsacPlaneOptions& options = {},
                        Monitor& monitor = silent_monitor());

}  // namespace limen
