// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/match/planes/direction_clusters.h"
#include "limen/match/segments/segment_distance.h"
#include "limen/register/published/published_pose.h"

// Monasse, Djahel, Vallet 2023, section III-B: a façade of each scan is drawn, a corner of an opening of
// each, and two planes across the façade; the pose of smallest distance (8) is kept.
//
// Departures from the printed text:
// - the façades are parallel as soon as the pose is right, and parallel planes have no line of intersection
//   to turn about: the rotation is that of their frames (outward normal, up). The indoor normal opposes the
//   outdoor one. This needs the vertical of both scans;
// - as printed, the vector from A to B lays the indoor face of the wall on its outdoor face. Where the user
//   gives a thickness, the chosen pose is moved back by it; else the shift across the wall is not held, and
//   said so;
// - the planes across the façade are those of Algorithm 1's clusters that lie within 10 degrees of it;
// - the number of trials is not given: `trials`;
// - those of match/segments/segment_distance.h (1 to 8) and match/planes/direction_clusters.h.

namespace limen {

struct Hybrid2023Options {
  DirectionClusterOptions clusters;
  SegmentDistanceOptions distance = {.weight = SegmentWeight::relative};
  std::size_t max_polygons = 24;  ///< of the source, those of most inliers
  std::size_t trials = 40000;
};

/// The pose of smallest distance. The criterion is equation 8, summed over both scans, m^2, lower is better.
/// Deterministic for a seed.
PublishedAnswer register_hybrid_2023(const PublishedInput& input, const Hybrid2023Options& options = {});

}  // namespace limen
