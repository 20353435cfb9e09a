// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "limen/cli/terminal/command.h"
#include "limen/report/deviation/deviation_issues.h"

namespace limen {

/// What the user says of issues.
struct IssueChoice {
  std::string file;  ///< BCF; empty: none is wanted
  IssueOptions options;
};

/// Adds --bcf, --moved-m and --matter-m.
void add_issue_options(CommandLine& command, IssueChoice& choice);

/// How a model's elements come into the coordinates that a viewer of its file shows: without the map of an
/// IFC file. `world_from_elements` leads into the model's world coordinates.
IssueModel issue_model(const std::string& path, const BimModel& model, const Rigid3& world_from_elements);

/// "2026-03-01T12:00:00Z": when a file was last changed, so that the same files give the same bytes. The
/// first day of 1970 for what is no file.
std::string date_of_file(const std::filesystem::path& path);

}  // namespace limen
