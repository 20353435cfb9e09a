// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "limen/project/project_state.h"

namespace limen {

/// What a scan is called: its file as the user wrote it, with " #2" for one of several in a file.
std::string scan_name(const ProjectScan& scan);

/// The node of a scan by its name, or by its file's name without folders where only one is called so; -1:
/// none, or several.
int node_called(const std::string& name, const std::vector<ProjectNode>& nodes,
                const std::vector<ProjectScan>& scans);

}  // namespace limen
