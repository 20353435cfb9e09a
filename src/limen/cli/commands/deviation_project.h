// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "limen/cli/inputs/issue_file.h"
#include "limen/deviation/deviation.h"
#include "limen/report/html/html_cover.h"

namespace limen {

/// What the user says of measuring a whole project.
struct ProjectDeviation {
  std::string project;              ///< project.json
  std::vector<std::string> models;  ///< empty: those of the project
  std::string folder;
  std::string memory;
  bool force = false;
  int cloud_points = 3'000'000;
  double colour_limit_m = 0.05;
  DeviationOptions measuring;
  IssueChoice issues;
  ReportCover cover;
};

/// Whether a file is the project.json of `limen project`, by its name.
bool names_project(const std::string& path);

/// Throws Error where what `limen deviation` writes into `folder`, or the file of issues (empty: none), would
/// replace one of the inputs or one another.
void refuse_to_replace(const std::vector<std::string>& inputs, const std::string& folder,
                       const std::string& issues);

/// Measures every scan that is registered in a project's frame against its models, one scan at a time.
int run_project_deviation(const ProjectDeviation& command, const Session& session);

/// The exit status by the number of points on faces: where there are none, a warning and that of no match.
int status_of_matched(std::size_t matched, const Session& session);

}  // namespace limen
