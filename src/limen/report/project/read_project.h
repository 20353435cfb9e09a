// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "limen/geometry/rigid.h"

namespace limen {

/// A scan as project.json tells of it.
struct ProjectEntry {
  std::string file;
  int index = 0;
  bool model = false;
  std::string state;
  std::optional<Rigid3> frame_from_scan;  ///< empty where it has no place in the project's frame
};

/// Its scans and models. Throws Error that names the file and the fault.
std::vector<ProjectEntry> read_project(const std::filesystem::path& path);

}  // namespace limen
