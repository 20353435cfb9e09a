// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "limen/match/openings/enumerate_opening_poses.h"

// Monasse, Djahel, Vallet, "Registration for urban modeling based on linear and planar features", 2023,
// section III-B: openings fix the rotation and two shifts, planes the third.
//
// Departures from the printed text:
// - the two walls are parallel as soon as the rotation is right, and parallel planes have no line of
//   intersection to turn about: rotations come from frames (outward normal, up);
// - the indoor normal opposes the outdoor one;
// - as printed, the vector from A to B lays the inner face of the wall on its outer face. Here the third
// shift
//   is the one that lays planes seen by both scans (the back wall of a room seen through its windows) on each
//   other; the wall's thickness follows from it, and must be a possible one;
// - all pairs of planes vote instead of a random pair.

namespace limen {

struct HybridPoseOptions {
  OpeningPoseOptions openings;
  std::optional<double> wall_thickness_m;  ///< given by the user: then no other assumption is made
};

/// A pose proposed by openings and planes, in the scans' local frames.
struct HybridPose {
  Rigid3 target_from_source;
  double support_m2 = 0.0;   ///< overlap of planes that agree along the normal, bounding rectangles
  double thickness_m = 0.0;  ///< of the wall at this pose
  OpeningPose opening;       ///< the pose it came from
};

/// Poses from openings and planes. A pose is in the list by the better of its two places, by the distance
/// of its openings and by the overlap of its planes, counted for each of the two cases of sides apart; equal
/// places go by distance. Where the user gave a thickness, that shift comes first of its opening pose's. A
/// pose whose normal nothing holds is listed with assumed thicknesses. Deterministic.
std::vector<HybridPose> enumerate_hybrid_poses(const Features& source, const Features& target,
                                               const HybridPoseOptions& options = {});

}  // namespace limen
