// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "limen/io/crs/coordinate_system.h"
#include "limen/project/inputs/pass_trajectories.h"
#include "limen/project/result/project_result.h"
#include "limen/report/json/result_json.h"

namespace limen {

/// The coordinate system of a project's frame, and what else a run knows of the world.
struct FrameSystem {
  CoordinateSystem system;  ///< as far as it is known
  std::string said_by;      ///< "user", or "file": one whose world coordinates are the frame's
  StatedTrajectories trajectories = {};
};

/// The text of project.json: the same bytes for the same files and options, whatever their order, the number
/// of threads, and what was kept from earlier runs.
std::string project_json(const ProjectResult& result, const OptionList& options,
                         const FrameSystem& system = {});

}  // namespace limen
