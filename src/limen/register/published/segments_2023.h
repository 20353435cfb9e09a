// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/base/angles.h"
#include "limen/match/planes/direction_clusters.h"
#include "limen/match/segments/segment_distance.h"
#include "limen/register/published/published_pose.h"

// Monasse, Djahel, Vallet 2023, section IV: segments clustered by direction; two associated clusters are
// drawn, one segment of each in both sets; the pose that lays the double pair on each other and has the
// smallest distance (8) is kept.
//
// Departures from the printed text:
// - (9) compares 1 - cos with an angle, and gives no sign: a cluster goes with the one of the other set that
//   the start brings nearest, each with one (largest |d . d| first), turned to its side;
// - a double pair is tried only where both sets hold the same |d_v . d_h| within `max_angle_rad` and the two
//   lines pass each other at the same distance within d of (7);
// - (8) is taken both ways, and over the `max_segments` longest segments of each set;
// - the number of trials is not given: `trials`;
// - those of match/planes/direction_clusters.h (algorithm 1), match/segments/segment_distance.h (1 to 8) and
//   match/solvers/rigid_from_lines.h (10 to 14).

namespace limen {

struct Segments2023Options {
  DirectionClusterOptions clusters;
  SegmentDistanceOptions distance = {.weight = SegmentWeight::relative};
  double max_angle_rad = radians(5.0);  ///< by which the angle within a double pair may differ
  std::size_t max_segments = 300;       ///< of each set, the longest
  std::size_t trials = 200000;          ///< double pairs drawn
};

/// The pose of smallest distance. The criterion is equation 8, summed over both sets, m^2, lower is better.
/// Deterministic for a seed.
PublishedAnswer register_segments_2023(const PublishedInput& input, const Segments2023Options& options = {});

}  // namespace limen
