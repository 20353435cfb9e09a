// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/geometry/polygon.h"

namespace limen {

/// A pair of the simple matching of Djahel, Monasse, Vallet 2021, section 3.2.1.
struct ThresholdMatch {
  int source = -1;          ///< index into the source's polygons
  int target = -1;          ///< index into the target's polygons
  double angle_rad = 0.0;   ///< acos |n1 . n2|
  double distance_m = 0.0;  ///< equation 7
  double overlap = 0.0;     ///< equation 8, in [0, 1]
  double overlap_m2 = 0.0;  ///< area in common
};

/// The paper's baseline: pairs within the three thresholds once `start_target_from_source` is applied,
/// largest common area first, each polygon once. It needs a good start and often gives no partner: that is
/// why the cluster matching exists. Departures are those of polygon_distance.h.
std::vector<ThresholdMatch> match_by_thresholds(const std::vector<PlanarPolygon>& source,
                                                const std::vector<PlanarPolygon>& target,
                                                const Rigid3& start_target_from_source);

}  // namespace limen
