// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/project/graph/configuration.h"
#include "limen/project/graph/pose_query.h"
#include "limen/project/graph/shared_views.h"

namespace limen {

/// All pairs that a configuration places in sight of each other: links that agree, pairs that show look-alike
/// places laid on one another, and, with `query`, pairs of which no link agrees: these are asked about the
/// placement. Things of a link's other pose are asked as well, for the pair asked of its best pose only.
std::vector<PlacedPair> placed_pairs(const PoseGraph& graph, const LinkMatcher& matcher,
                                     const Configuration& configuration, const PoseQuery& query);

/// What pairs say against a move by what would be in the free space that others saw: nats, none below 0.
/// Scans that come near one another are asked first, until one says `enough`.
double nats_against_move(const Configuration& configuration, const std::vector<bool>& side,
                         const Rigid3& frame_from_frame, double enough, const PoseQuery& query);

}  // namespace limen
