// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "limen/project/control/stated_poses.h"
#include "limen/project/project_state.h"

namespace limen {

/// Gives the nodes the places that `poses` state of their scans; a name that fits no scan, or several, is
/// noted. With `file_sigma_m` scans of one file that are known to one another are said to be as it has them,
/// as well as that, and the file's word counts no longer as a measurement.
void take_stated_places(const std::vector<StatedPose>& poses, std::optional<double> file_sigma_m,
                        const std::vector<ProjectScan>& scans, std::vector<ProjectNode>& nodes,
                        std::vector<std::string>& notes);

/// By how much the stated places of two scans make a pose more probable than it is without them: logarithm of
/// its density over the even one in the space that is searched. 0 where one of them is not stated. Poses
/// about the local origins, target from source. At least the logarithm of what is not trusted.
double log_prior_of_places(const ProjectNode& source, const ProjectNode& target, const Rigid3& pose);

/// Whether two scans can share anything where they are stated; true where one of them is not.
bool can_meet(const ProjectNode& a, const ProjectNode& b);

/// Of the scans that are placed in the project's frame: how far each is from its stated place, all of these
/// moved together as they fit best. Written to the scans; what the scans contradict is noted.
void compare_with_stated(const std::vector<ProjectNode>& nodes, ProjectResult& result);

}  // namespace limen
