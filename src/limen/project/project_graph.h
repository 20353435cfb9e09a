// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "limen/project/graph/pose_graph.h"
#include "limen/project/passes/bent_passes.h"
#include "limen/project/project_state.h"
#include "limen/project/words.h"

namespace limen {

/// Pairs as links of a graph, node by node.
struct ProjectGraph {
  PoseGraph graph;
  std::vector<int> pair_of;  ///< of each link: index of its pair, -1: the file gives it
};

/// Every pair that found something, with all its poses, and what files say of their own scans. A user's word
/// makes a pose surer, or leaves a link out: the loops still test it.
ProjectGraph make_graph(const std::vector<ProjectNode>& nodes, const std::vector<TriedPair>& pairs,
                        const UserWords& words);

struct PlacedSurvey;

/// What came of the joint adjustment.
struct JointFinding {
  /// By what the planes' deviations miss what was taken for them; 0: there was nothing to adjust, or it was
  /// not taken.
  double variance_factor = 0.0;
  std::vector<int> torn;      ///< nodes that it would move too far: then no node is moved
  double most_moved_m = 0.0;  ///< of those
  std::vector<bool> broken;   ///< of each of the user's words: the data contradict it
  /// Coordinates of control points contradict one another so that they hold no frame: nothing was moved.
  bool contradicted = false;
  std::vector<BentPass> passes;  ///< as they were bent; in the frame of the solution
};

/// The solved poses once more, with all planes that accepted links show to be shared (adjust/); nodes that
/// stand alone stay. The points of a survey enter as observations: first with the links alone, which tests
/// them, then with the planes too; `survey` tells what came of them. So do words on what is level.
JointFinding adjust_planes(const std::vector<ProjectNode>& nodes, const std::vector<TriedPair>& pairs,
                           const ProjectGraph& made, const UserWords& words, SolvedGraph& solved,
                           PlacedSurvey& survey);

/// The graph with the poses of its links as bent passes have them: a link measures where a pass stood when it
/// saw what both see, which drift has moved against the pass as a whole. How passes are bent is found from
/// what `solved` accepted; what that leaves open is added to the covariances. Empty where nothing bends, or
/// no link misses by what a drift may be.
std::optional<PoseGraph> straightened(const std::vector<ProjectNode>& nodes,
                                      const std::vector<TriedPair>& pairs, const ProjectGraph& made,
                                      const SolvedGraph& solved);

}  // namespace limen
