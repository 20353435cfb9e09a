// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/match/segments/segment_votes.h"

namespace limen {

/// Rotations for sets that have but one direction in common, where no second direction fixes the turn about
/// it: the turns under which most pairs of parallel source lines lie to each other as pairs of target lines
/// do. Both senses of the direction where `gravity_known` is false; with it the direction is the vertical.
/// Most pairs first, at most 24; deterministic.
std::vector<Matrix3d> parallel_rotations(const VotingSegments& source, const VotingSegments& target,
                                         const AxisDirection& source_axis, const AxisDirection& target_axis,
                                         const RotationOptions& options);

}  // namespace limen
