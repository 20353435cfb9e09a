// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/geometry/segment.h"
#include "limen/match/planes/enumerate_poses.h"

// Monasse, Djahel, Vallet, "Registration for urban modeling based on linear and planar features", 2023,
// sections IV-B (rotations from clusters of directions), IV-C (double pairs of segments) and IV-D (closed
// form).
//
// Departures from the printed text:
// - (9) associates each cluster with the nearest of the other set, which presumes a good start and may take
//   one cluster twice: here every association of two directions with two, both signs, one to one, and the
//   least-squares rotation over all directions that then agree. Known gravity keeps the vertical vertical;
// - any number of directions, not three;
// - the double pairs of IV-C are not drawn at random. Two parallel segments of one direction fix two
//   components of the shift: every such pair votes in a plane of shifts, one plane per direction. A place
//   in one plane (the first pair) is completed by the component that most pairs of the other directions want
//   (the second pair). The printed tests on a double pair - |d_v . d_h| and the distance of the two lines
//   agree in both sets - hold for all pairs that vote for one shift;
// - (8) is taken in pieces: each piece of the smaller set counts its length times 1 - (d / 0.15 m)^2,
//   d its distance to the nearest segment of the other set in its direction.

namespace limen {

struct SegmentPoseOptions {
  bool gravity_known = true;           ///< both z axes point up: only turns about the vertical are tried
  double gravity_tolerance_deg = 4.0;  ///< by how much a level set may be off
};

/// Poses that lay segments of the source on segments of the target, for any starting pose. Best first, no two
/// alike; every place where the smaller set repeats in the larger one is among them. `precedence` of a pose
/// is in metres here: covered length of the smaller set, weighted as in (8). Where all segments in common
/// have one direction the shift along it is made up. Deterministic, and independent of threads.
std::vector<PoseCandidate> enumerate_segment_poses(const std::vector<Segment>& source,
                                                   const std::vector<Segment>& target,
                                                   const SegmentPoseOptions& options = {});

}  // namespace limen
