// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/project/graph/pose_graph.h"

namespace limen {

/// How sure the join was that brought a node to its part.
enum class JoinTrust { sure, likely, open, weak };

/// Nodes put together step by step.
struct GrownParts {
  std::vector<int> part;               ///< of each node: the lowest node of its part
  std::vector<Rigid3> part_from_node;  ///< in the frame of that lowest node
  std::vector<JoinTrust> trust;  ///< the least sure join between the node and the larger rest of its part
};

/// Maximum-evidence forest: two parts are joined in the way whose odds are best, the pair of parts first that
/// is surest of its way. A pose speaks for a way by its probability against that none of its link is right;
/// links that see the same say it once; what speaks for another way speaks against it. That a place has a
/// twin is believed once, whatever number of links lay the parts on one another. `votes`: loops of sure links
/// that a pose closes. Weak links come last, those `left_out` not at all.
GrownParts grow_parts(const PoseGraph& graph, const std::vector<std::vector<int>>& votes,
                      const std::vector<bool>& left_out);

}  // namespace limen
