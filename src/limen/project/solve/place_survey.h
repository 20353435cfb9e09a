// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "limen/project/solve/project_graph.h"
#include "limen/project/survey/survey.h"

namespace limen {

/// Adds a link between scans that see the same targets, where three or more determine their pose;
/// contradictory ones are in the notes.
void add_target_links(Survey& survey, ProjectGraph& made);

/// Adds the survey's frame as a node, and a link to it of every scan whose own targets determine its pose
/// there; contradictory ones are in the notes. Nothing where there are no control points.
void add_survey_links(Survey& survey, ProjectGraph& made);

/// Scans that are in doubt, or stand in a frame of their own, and that known points confirm: the points of
/// all other scans of the component fix its frame, and foretell those that this scan sees. They are linked to
/// the survey's frame, so that the graph is to be solved again; false: there are none.
bool confirm_by_points(const Survey& survey, const SolvedGraph& solved, ProjectGraph& made);

/// The survey against a solved graph.
struct PlacedSurvey {
  bool placed = false;              ///< at least one component is in the survey's frame
  std::string words;                ///< what came of it, one sentence
  std::vector<bool> controlled;     ///< of each node: is in the survey's frame
  std::vector<MarkedPoint> points;  ///< of each mark: as it enters the adjustment
  /// Of each point: the numbers of the mark's sights that count.
  std::vector<std::vector<std::size_t>> sights;
  std::vector<std::vector<Vector3d>> seen_at;  ///< of each sight of each mark: its place, as it was adjusted
  std::vector<bool> candidates;                ///< coordinates that may enter
  SettledPoints settled;                       ///< the last adjustment with them
};

/// Takes the survey's node out of the graph and moves every component that control points hold in all six
/// freedoms into its frame: they become one, number 0. Others keep the frame of their own, and `words` say
/// so.
PlacedSurvey place_survey(const Survey& survey, ProjectGraph& made, SolvedGraph& solved);

}  // namespace limen
