// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/match/planes/threshold_matching.h"
#include "limen/register/published/published_pose.h"

// Djahel, Monasse, Vallet 2021, section 3.2.1: polygons that agree within three thresholds at the start.
//
// Departures from the printed text:
// - the text gives no thresholds: those of ThresholdMatchingOptions, one partner for each polygon;
// - nor does it say how matches become a pose: here least squares over all of them, which is 3.3 (a rotation
//   from pairs of directions) and 3.4 (a shift from pairs of planes) for any number of pairs;
// - those of match/planes/polygon_distance.h and of the two solvers.

namespace limen {

struct Threshold2021Options {
  ThresholdMatchingOptions matching = {.one_to_one = true};
  std::size_t max_polygons = 24;  ///< of each scan, those of most inliers; the paper has 22 and 23
};

/// The pose that lays the matched polygons on each other. The criterion is equation 10 summed over both
/// scans (rdist, symmetrised), m^2, higher is better; nothing is chosen by it.
PublishedAnswer register_threshold_2021(const PublishedInput& input,
                                        const Threshold2021Options& options = {});

}  // namespace limen
