// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "limen/project/graph/pose_graph.h"
#include "limen/project/passes/bent_passes.h"
#include "limen/project/state/project_node.h"
#include "limen/project/state/words.h"

namespace limen {

/// Pairs as links of a graph, node by node.
struct ProjectGraph {
  PoseGraph graph;
  std::vector<int> pair_of;        ///< of each link: index of its pair, -1: the file gives it
  std::vector<int> pair_in_place;  ///< of each pose measured in place: index of its pair
};

/// Whether a pair proposes poses. Those that are more probably none are what any two scans show: many of them
/// would outweigh what is sure. `spoken`: a user said something of the pair.
bool makes_link(const RegistrationResult& found, bool spoken);

/// Every pair that found something, with all its poses, and what files say of their own scans. A user's word
/// makes a pose surer, or leaves a link out: the loops still test it.
ProjectGraph make_graph(const std::vector<ProjectNode>& nodes, const std::vector<TriedPair>& pairs,
                        const UserWords& words);

}  // namespace limen
