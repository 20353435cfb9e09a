// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "limen/project/result/project_result.h"
#include "limen/project/state/project_node.h"

namespace limen {

/// Gives the nodes the scanner positions that `positions` state, by the names of their scans. A name that
/// fits no scan, or several, is noted. With `file_sigma_m` the positions that a file states for its scans are
/// taken as well, with this standard deviation in metres, and no longer as exact poses.
void take_stated_positions(const std::vector<SurveyedPoint>& positions, std::optional<double> file_sigma_m,
                           const std::vector<ProjectScan>& scans, std::vector<ProjectNode>& nodes,
                           std::vector<std::string>& notes);

/// Whether two scans can share a surface where their positions are stated. True where one of them is not.
bool can_meet(const ProjectNode& a, const ProjectNode& b);

/// Compares the scans placed in the project's frame with their stated positions, after the rigid motion that
/// fits most of them. Writes the distances to the scans, and notes the positions that the scans contradict.
void compare_with_stated(const std::vector<ProjectNode>& nodes, ProjectResult& result);

}  // namespace limen
