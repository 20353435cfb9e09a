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

/// Maximum-evidence forest: two parts are joined by the pose that most links between them agree on, the pair
/// of parts with the most evidence first. `votes` of the loops count with a link's own evidence. First by
/// poses that a sure link bears, or that two links agree on; then by those that may lie on a twin; then by
/// open ones; then by weak ones.
GrownParts grow_parts(const PoseGraph& graph, const std::vector<std::vector<int>>& votes);

}  // namespace limen
