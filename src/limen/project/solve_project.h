// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/base/progress.h"
#include "limen/project/result/project_result.h"

namespace limen {

/// Puts scans that are in memory into one frame, as run_project() does those in files. They are called
/// scan_1, scan_2 and so on, in their order, and pass through a temporary folder. Throws Error where there is
/// none, or that folder cannot be written.
ProjectResult solve_project(const std::vector<Scan>& scans, Monitor& monitor = silent_monitor());

}  // namespace limen
