// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "limen/project/control/settle_points.h"
#include "limen/project/inputs/project_options.h"
#include "limen/project/result/project_result.h"
#include "limen/project/state/project_node.h"

namespace limen {

/// A point of a survey with the nodes that see it.
struct SurveyMark {
  std::string name;
  PointRole role = PointRole::tie;
  bool scanner = false;           ///< where a scanner stood
  std::optional<Vector3d> given;  ///< world of the survey
  MarkedPoint point;              ///< relative to the survey's origin; sights to the nodes' local origins
};

/// Control, check and tie points of a project, by name.
struct Survey {
  std::string file;                    ///< that of the control points, empty: there are none
  Vector3d origin = Vector3d::Zero();  ///< near the control points, whole metres
  std::vector<SurveyMark> marks;
  std::vector<std::string> node_names;
  std::vector<Vector3d> up;  ///< of each node, its axes; zero where it is not known, empty where none is
  std::vector<std::string> notes;
};

/// Reads the survey's files and finds the scans that they name (as the user wrote them, or by their file's
/// name alone; " #2" for one of several in a file). Throws Error where a file is no good, or a point is both
/// control and check point; names that are not part of the project are in the notes.
Survey read_survey(const ProjectInputs& inputs, const std::vector<ProjectNode>& nodes,
                   const std::vector<ProjectScan>& scans);

}  // namespace limen
