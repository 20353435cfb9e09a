// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/project/adjust/plane_adjustment.h"
#include "limen/project/passes/bent_passes.h"
#include "limen/project/solve/place_survey.h"
#include "limen/project/solve/project_graph.h"
#include "limen/project/solve/shared_planes.h"

namespace limen {

/// Passes with a way that stand in a component: what bends.
BentPasses passes_to_bend(const std::vector<ProjectNode>& nodes, const SolvedGraph& solved);

/// What a solved graph leaves to be adjusted: its accepted links, the planes that they show to be shared, and
/// the points of a survey, of passes that bend part by part.
JointProblem joint_problem(const std::vector<ProjectNode>& nodes, const std::vector<TriedPair>& pairs,
                           const ProjectGraph& made, const SolvedGraph& solved, const PlacedSurvey& survey,
                           BentPasses& passes);

/// Where along its way one of a pair's scans, a pass, saw what both see; `target_from_source` is the pair's
/// best pose, about the nodes' origins.
std::vector<double> common_places(const std::vector<ProjectNode>& nodes, const TriedPair& pair,
                                  const Rigid3& target_from_source, bool source, const SharedPlanes& shared);

/// What is held by a frame that is no scan's gets a scan of its own as the frame, one that has no
/// deviations: of each component without any, but those that are `controlled`, the first that is held firmly,
/// or the first.
void give_references(const std::vector<bool>& controlled, SolvedGraph& solved);

/// The component of each node.
std::vector<int> components_of(const SolvedGraph& solved);

/// The shape of the passes, and how fast they drift, in the frame as it is solved so far: planes are joined
/// anew once passes are bent.
void bend(const std::vector<ProjectNode>& nodes, const std::vector<TriedPair>& pairs,
          const ProjectGraph& made, SolvedGraph solved, const PlacedSurvey& survey, BentPasses& passes);

/// No trajectory that deserves the name is off by more than half a metre or half a degree: then something
/// else is wrong, and passes stay rigid.
bool drift_is_plausible(const std::vector<BentPass>& passes);

}  // namespace limen
