// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/solve_project.h"

#include <filesystem>

#include <fmt/format.h>

#include "limen/base/scratch_folder.h"
#include "limen/io/ply/ply.h"
#include "limen/project/project.h"

namespace limen {

ProjectResult solve_project(const std::vector<Scan>& scans, Monitor& monitor) {
  const ScratchFolder folder(std::filesystem::temp_directory_path(), "limen-project");
  ProjectInputs inputs;
  for (const Scan& scan : scans) {
    scan.check();
    const auto path = folder.path() / fmt::format("scan_{}.ply", inputs.scans.size() + 1);
    write_ply(path, scan);
    inputs.scans.push_back(path.string());
  }
  const ProjectOptions options;
  ProjectResult result = run_project(inputs, folder.path(), options, monitor);
  for (ProjectScan& scan : result.scans) scan.file = std::filesystem::path(scan.file).stem().string();
  return result;
}

}  // namespace limen
