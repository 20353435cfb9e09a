// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/match/segments/segment_distance.h"
#include "limen/register/published/published_pose.h"

// Djahel, Monasse, Vallet 2022, sections 3.2 and 3.3: a wall of each scan is drawn, a vertical and a
// horizontal edge of each; the pose that lays them on each other and has the smallest distance (14) is kept.
//
// Departures from the printed text:
// - the openings are those that limen finds (extract/openings), whose rectangles stand upright;
// - a direction's sign is not given: verticals point up, and horizontals so that the scanners stand on the
// two
//   sides of the wall, as indoor and outdoor scans do;
// - the number of trials is not given: `trials`;
// - those of match/segments/segment_distance.h (3 to 14; the four end points are those of the whole segments,
//   as printed) and of match/solvers/rigid_from_lines.h (15 to 19).
// As printed, the two faces of a wall are laid on each other: the shift across it is not held, and said so.

namespace limen {

struct Openings2022Options {
  SegmentDistanceOptions distance = {.whole_segments = true};
  std::size_t trials = 40000;
};

/// The pose of smallest distance. The criterion is equation 14 over all edges of both scans, m^3, lower is
/// better. Deterministic for a seed.
PublishedAnswer register_openings_2022(const PublishedInput& input, const Openings2022Options& options = {});

}  // namespace limen
