// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include "limen/project/graph/pose_graph.h"

namespace limen {

/// Where the accepted links of a solved graph lay one node against another, and how well they know it; of
/// pairs (source, target) within one component.
std::vector<LinkPose> known_poses(const PoseGraph& graph, const SolvedGraph& solved,
                                  const std::vector<std::pair<int, int>>& pairs);

}  // namespace limen
