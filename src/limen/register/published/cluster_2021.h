// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/match/planes/direction_clusters.h"
#include "limen/match/planes/polygon_distance.h"
#include "limen/register/published/published_pose.h"

// Djahel, Monasse, Vallet 2021, section 3.2.2: polygons clustered by direction, then by offset; one pair of
// planes from each of three associated clusters makes a hypothesis, and the best by (10) is kept.
//
// Departures from the printed text:
// - "by their offset" is announced and never defined: planes of one direction whose offsets lie within
//   `same_offset_m` of the one of most inliers are one, which represents them;
// - all triples are enumerated, as printed, but compared in the order of an upper estimate of (10) - what the
//   offsets alone allow, axis by axis, every overlap being as large as the smaller polygon - and no further
//   than to where the estimate falls below the best value found;
// - the three clusters that the text takes for granted may be missing: then there is no pose, and why is
// said;
// - those of match/planes/direction_clusters.h (algorithm 1), polygon_distance.h (7, 9, 10),
//   match/solvers/rotation_from_directions.h (11 to 19) and translation_from_planes.h (20 to 22).

namespace limen {

struct Cluster2021Options {
  DirectionClusterOptions clusters;
  AgreementOptions agreement;     ///< d_thr of (9) and (10)
  double same_offset_m = 0.05;    ///< planes of one direction nearer than this are one
  std::size_t max_polygons = 24;  ///< of each scan, those of most inliers; the paper has 22 and 23
};

/// The best hypothesis. The criterion is (10) over the polygons of associated clusters, summed over both
/// scans (rdist, symmetrised), m^2, higher is better.
PublishedAnswer register_cluster_2021(const PublishedInput& input, const Cluster2021Options& options = {});

}  // namespace limen
