// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/project/result/project_result.h"
#include "limen/project/solve/project_graph.h"

namespace limen {

/// A solution to hold the user's words against.
struct WordsAndSolution {
  const std::vector<ProjectNode>& nodes;
  const std::vector<TriedPair>& pairs;
  const UserWords& words;
  const std::vector<bool>& broken;      ///< of each decision on what is level: as JointFinding tells it
  const std::vector<bool>& controlled;  ///< of each node: whether it is in the frame of a survey
  const PoseGraph& graph;
  const SolvedGraph& solved;
  const std::vector<int>& pair_of;  ///< of each link
};

/// What became of each decision: kept, contradicted by other links or planes, or of no use, and why.
std::vector<ProjectDecision> judged_decisions(const WordsAndSolution& all);

}  // namespace limen
