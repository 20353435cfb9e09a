// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/base/angles.h"
#include "limen/geometry/polygon.h"

namespace limen {

/// Thresholds of the simple matching of Djahel, Monasse, Vallet 2021, section 3.2.1.
struct ThresholdMatchingOptions {
  double max_angle_rad = radians(5.0);  ///< in (0, pi/2]
  double max_distance_m = 0.2;          ///< of equation 7, > 0
  double min_overlap = 0.3;             ///< of equation 8, in [0, 1]
  bool one_to_one = false;              ///< keep for each polygon at most one partner, larger overlaps first

  void check() const;
};

struct ThresholdMatch {
  int source = -1;          ///< index into the source's polygons
  int target = -1;          ///< index into the target's polygons
  double angle_rad = 0.0;   ///< acos |n1 . n2|
  double distance_m = 0.0;  ///< equation 7
  double overlap = 0.0;     ///< equation 8, in [0, 1]
  double overlap_m2 = 0.0;  ///< area in common
};

/// The paper's baseline: all pairs within the three thresholds once `start_target_from_source` is applied,
/// largest common area first. It needs a good start and often gives several partners or none: that is why
/// the cluster matching exists. Departures are those of polygon_distance.h.
std::vector<ThresholdMatch> match_by_thresholds(const std::vector<PlanarPolygon>& source,
                                                const std::vector<PlanarPolygon>& target,
                                                const Rigid3& start_target_from_source,
                                                const ThresholdMatchingOptions& options = {});

}  // namespace limen
