// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "limen/geometry/rigid.h"
#include "limen/geometry/spline_motion.h"

namespace limen {

/// A scan as project.json tells of it.
struct ProjectEntry {
  std::string file;
  int index = 0;
  bool model = false;
  std::string state;
  std::optional<Rigid3> frame_from_scan;     ///< empty where it has no place in the project's frame
  std::shared_ptr<const SplineMotion> bend;  ///< of a pass that drifted: what moves it then, by time
};

/// Its scans and models. Throws Error that names the file and the fault.
std::vector<ProjectEntry> read_project(const std::filesystem::path& path);

}  // namespace limen
