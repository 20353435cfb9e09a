// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "limen/base/progress.h"
#include "limen/extract/planes/plane_labels.h"
#include "limen/model/scan.h"

// Planes of a scan whose lines are known: Djahel, Monasse, Vallet 2021, section 2.1, after Guinard et al.
// 2020: one sample drawn at random and two in its neighbourhood on the grid of scan lines, a region grown
// over that grid from the first sample, the patch with most inliers kept.
//
// Departures:
// - regions grow only over links between true neighbours (see ScanGrid): a line of sight that jumps from a
//   wall to a tree does not carry the wall over;
// - samples are judged by MSAC over their neighbourhood first, and only the best of a round are grown, best
//   first; the number of trials follows from the smallest plane wanted and a confidence, not from a constant;
// - all echoes of one profile lie in the plane that the beam sweeps: samples come from two lines at least,
// and
//   planes seen along their own surface are refused;
// - the plane is refitted by least squares while it grows, then grown anew; pieces that continue one plane
//   (a wall behind trees) become one, and points between two planes go to the nearer one.

namespace limen {

struct TopologyPlaneOptions {
  double inlier_threshold_m = 0.0;  ///< 0: 3.3 times the noise found in the scan, between 10 and 40 mm
  int min_inliers = 200;            ///< smallest plane, points, >= 12
  std::uint64_t seed = 1;
};

/// Planes, most inliers first, and the plane of each point. The scan must have a topology.
PlaneLabels extract_topology_planes(const Scan& scan, const TopologyPlaneOptions& options = {},
                                    Monitor& monitor = silent_monitor());

}  // namespace limen
