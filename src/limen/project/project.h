// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "limen/base/progress.h"
#include "limen/project/decide/decisions.h"
#include "limen/project/inputs/project_options.h"
#include "limen/project/result/project_result.h"
#include "limen/project/state/project_status.h"

namespace limen {

/// Puts any number of scans, and building models, into one frame. Features of scans and results of pairs are
/// kept under `folder`/store, and only what is missing is made. A file that cannot be read is named in its
/// scan's reason. The result depends on the names and bytes of the files and the options alone.
/// Throws Error where there is no scan, or the store cannot be written.
ProjectResult run_project(const ProjectInputs& inputs, const std::filesystem::path& folder,
                          const ProjectOptions& options = {}, Monitor& monitor = silent_monitor());

/// Adds a decision to those that are kept in a project's folder, for the next run; returns them all.
/// `full_name`: how the project calls a scan that a decision names. Throws Error where `folder` holds no
/// project.
std::vector<Decision> decide(const std::filesystem::path& folder, const Decision& decision,
                             const std::function<std::string(const std::string&)>& full_name = {});

}  // namespace limen
