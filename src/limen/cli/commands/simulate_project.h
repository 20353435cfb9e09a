// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "limen/cli/terminal/command.h"
#include "limen/simulate/whole/project_scene.h"

namespace limen {

/// `limen simulate BUILDING --project -o DIR`: scans a whole building, one file a scan, and writes task.json
/// and truth/project.json. `options.seed` is set.
int run_simulate_project(const ProjectSceneOptions& options, const std::string& output,
                         const Session& session);

}  // namespace limen
