// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/base/progress.h"
#include "limen/extract/planes/plane_labels.h"
#include "limen/model/features.h"
#include "limen/model/scan.h"

namespace limen {

/// Planes cut into the pieces that are connected, each fitted for itself: the ceilings of two rooms seen
/// through their windows may be one plane to a few millimetres, and neither room's. Pieces follow each other
/// in the order of their planes, the largest first; small ones are dropped.
PlaneLabels split_planes(const Scan& scan, const PlaneLabels& planes);

struct PolygonOptions {
  double alpha_m = 0.0;       ///< radius of the alpha shape; 0: from the spacing of each plane's points
  double min_part_m2 = 0.02;  ///< smaller parts of a plane are dropped
  double min_hole_m2 = 0.02;  ///< smaller holes are filled
  double simplify_m = 0.01;   ///< outlines may move by this much

  void check() const;
};

/// Planes with labels become planar polygons: alpha shape of the inliers projected into the plane
/// (2021, section 2.2), the normal turned to the side the scanner saw. In the order of `labels.fits`.
std::vector<PlanarPolygon> make_polygons(const Scan& scan, const PlaneLabels& labels,
                                         const PolygonOptions& options = {},
                                         Monitor& monitor = silent_monitor());

}  // namespace limen
