// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/project/graph/pose_hearing.h"
#include "limen/project/graph/shared_views.h"

namespace limen {

/// By how much what two nodes contradict speaks against their pose, natural logarithm: nothing, as far as
/// doors and furniture may have moved.
double nats_of_contradiction(const PoseHeard& heard);

/// By how much what others saw of another place for `node` speaks against it, natural logarithm; less than
/// nothing where they speak against the present one rather.
///
/// A link that proposes a place asks two scans; all that stand about there have seen it as well. Walls that
/// would stand in the free space of others, or theirs in its own, refute the place, whatever agrees: what was
/// built alike agrees by design. Heard are the nodes of the same component that stand `firm`, and of what
/// they say against the other place only the one that says most: what several saw is one observation. Against
/// the present place all count.
double nats_against_place(const AcceptedPoses& accepted, int node, const Rigid3& frame_from_frame,
                          const std::vector<bool>& firm, const PoseHearing& hearing);

}  // namespace limen
