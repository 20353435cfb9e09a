// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/project/graph/pose_graph.h"

namespace limen {

/// How sure the join was that brought a node to its part.
enum class JoinTrust { sure, likely, open, weak };

/// A part that was put together with a larger one in a way that is not sure.
struct GrownJoin {
  std::vector<int> smaller;
  JoinTrust trust = JoinTrust::likely;
};

/// Nodes put together step by step.
struct GrownParts {
  std::vector<int> part;               ///< of each node: the lowest node of its part
  std::vector<Rigid3> part_from_node;  ///< in the frame of that lowest node
  std::vector<GrownJoin> joins;        ///< those that are not sure, in their order

  /// Of each node the least sure join between it and `reference`. From the smaller side of a join all else is
  /// no surer than that, also what came to the part later, for it may hang on the larger side.
  [[nodiscard]] std::vector<JoinTrust> trust_from(int reference) const;
  /// The same seen from the larger side of every join.
  [[nodiscard]] std::vector<JoinTrust> trust() const { return trust_from(-1); }
};

/// Maximum-evidence forest: two parts are joined in the way whose odds are best, the pair of parts first that
/// is surest of its way. A pose speaks for a way by its probability against that none of its link is right;
/// links that see the same say it once; what speaks for another way speaks against it. That a place has a
/// twin is believed once, whatever number of links lay the parts on one another. `votes`: loops of sure links
/// that a pose closes. Weak links come last, those `left_out` not at all.
GrownParts grow_parts(const PoseGraph& graph, const std::vector<std::vector<int>>& votes,
                      const std::vector<bool>& left_out);

}  // namespace limen
