// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "limen/cli/inputs/scan_options.h"
#include "limen/io/cloud/transform_cloud.h"
#include "limen/project/inputs/pass_trajectories.h"
#include "limen/report/project/read_project.h"

namespace limen {

/// What the user says of the trajectories of a project's passes.
struct TrajectoryChoice {
  std::vector<std::string> files;
  ReadingChoice reading;  ///< columns, zone, offset and lever arm of all of them
};

/// Adds --trajectory, which may be given several times, and what belongs to it.
void add_trajectories_option(CommandLine& command, TrajectoryChoice& choice);

/// What was chosen, as project.json tells it. `system`: of the project's frame, which latitudes and
/// longitudes come into where no zone is named.
StatedTrajectories stated_trajectories(const TrajectoryChoice& choice, const CoordinateSystem& system);

/// Writes where the scanner of a pass was, corrected, beside its cloud `output`: NAME_trajectory.csv, and
/// NAME_trajectory.sbet where the system of the frame and PROJ are there. Sentences about what could not be
/// written.
std::vector<std::string> write_pass_trajectory(const ProjectEntry& pass, const StatedTrajectories& stated,
                                               const CoordinateSystem& system,
                                               const std::filesystem::path& output, Monitor& monitor);

}  // namespace limen
