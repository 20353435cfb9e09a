// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/model/features.h"
#include "limen/model/pose_candidate.h"

namespace limen {

struct PoseEnumerationOptions {
  bool gravity_known = true;           ///< both z axes point up: only turns about the vertical are tried
  double gravity_tolerance_deg = 4.0;  ///< by how much a level scanner may be off
  double direction_deg = 5.0;          ///< normals nearer than this are one direction
  int max_poses = 3000;                ///< poses returned

  void check() const;
};

/// Poses that put planes of the source on planes of the target, for any starting pose: rotations from pairs
/// of directions, then the shifts along each axis separately, then triples of shifts ranked by overlap (2021,
/// section 3.2.2). Best first, no two alike. Deterministic.
///
/// Departures: any number of directions instead of three, all their associations and signs instead of the
/// smallest angle; the rotation is the least-squares one over all associated directions (3.3 is its two-pair
/// case); the three offsets are separated per axis, so that a few hundred shifts replace 178 000 triples; the
/// criterion (eq. 10) is taken over bounding rectangles here and over the seen surface later.
std::vector<PoseCandidate> enumerate_poses(const Features& source, const Features& target,
                                           const PoseEnumerationOptions& options = {});

/// Poses for scans whose common planes fix only two shifts: for every rotation and pair of axes the best
/// shifts, swept along the third direction in steps of `step_m` as far as the planes can meet.
/// `precedence` is the limit of the two shifts: those of the highest are returned.
std::vector<PoseCandidate> enumerate_sliding_poses(const Features& source, const Features& target,
                                                   double step_m, const PoseEnumerationOptions& options = {});

}  // namespace limen
