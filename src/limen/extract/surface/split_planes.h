// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/extract/planes/plane_labels.h"
#include "limen/model/scan.h"

namespace limen {

struct SplitOptions {
  double gap_m = 0.4;    ///< pieces of a plane farther apart are planes of their own; > 0
  int min_inliers = 25;  ///< smaller pieces are dropped; 3 or more

  void check() const;
};

/// Planes cut into the pieces that hang together, each fitted for itself: the ceilings of two rooms seen
/// through their windows may be one plane to a few millimetres, and neither room's. Pieces follow each other
/// in the order of their planes, the largest first.
PlaneLabels split_planes(const Scan& scan, const PlaneLabels& planes, const SplitOptions& options = {});

}  // namespace limen
