// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/match/planes/enumerate_poses.h"

namespace limen {

struct ModelPoseOptions {
  bool gravity_known = true;           ///< both z axes point up: only turns about the vertical are tried
  double gravity_tolerance_deg = 4.0;  ///< by how much a level scanner may be off
  int anchors = 4;                     ///< planes of the scan tried per direction, largest first, >= 1
  int max_poses = 6000;                ///< poses returned, those that most anchors agree on first
};

/// Poses that lay three planes of a scan, facing three directions, on three of a model, wherever their
/// outlines then overlap: every place of a whole building where a room may be, for any starting pose. The
/// planes must be oriented where `oriented` says so. `precedence` is the number of anchors that agree; score
/// them all.
///
/// This is 2021, section 3.2.2, turned round: not the shifts of each axis separately, for a building has
/// hundreds on each, but three planes at a time that meet near one another. Cost: for every pair of anchors
/// those pairs of the model's planes of their directions that stand near one another, found in a grid; the
/// third plane is looked up where it crosses the line of shifts that the others leave. Memory: that of
/// `max_poses` poses, and of the shifts under a few rotations at a time.
std::vector<PoseCandidate> enumerate_model_poses(const Features& scan, const Features& model,
                                                 const ModelPoseOptions& options = {});

}  // namespace limen
