// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/project/passes/bent_passes.h"
#include "limen/project/solve/place_survey.h"
#include "limen/project/solve/project_graph.h"

namespace limen {

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

}  // namespace limen
