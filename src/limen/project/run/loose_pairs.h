// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/project/graph/link_pose.h"
#include "limen/project/solve/project_graph.h"
#include "limen/project/state/project_node.h"
#include "limen/project/state/words.h"

namespace limen {

/// Two scans that the links hold only loosely to one another, source > target.
struct LoosePair {
  std::size_t source = 0;
  std::size_t target = 0;
  LinkPose placed;  ///< where the links have them
};

/// Pairs of static scans whose place is sure, which no link joins, of which a user said nothing, and which
/// should see enough of one another: the few of each loosely held scan that should see most. Measured once
/// more from where they are, they say how exactly. By nodes.
std::vector<LoosePair> loose_pairs(const std::vector<ProjectNode>& nodes, const ProjectGraph& made,
                                   const UserWords& words, const SolvedGraph& solved);

}  // namespace limen
