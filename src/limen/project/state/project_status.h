// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace limen {

/// How far a project is, from its folder alone.
struct ProjectStatus {
  std::string stage;           ///< "features", "pairs", "done"
  std::size_t scans = 0;       ///< files in the last run
  std::size_t ready = 0;       ///< files whose features are kept
  std::size_t pairs = 0;       ///< pairs chosen so far
  std::size_t tried = 0;       ///< of them: whose result is kept
  std::size_t copies = 0;      ///< files of the same bytes as another, which needs no features of its own
  std::size_t unreadable = 0;  ///< files that gave no features
};
/// Throws Error where `folder` holds no project.
ProjectStatus project_status(const std::filesystem::path& folder);
/// Writes it to the store.
void write_status(const std::filesystem::path& folder, const ProjectStatus& status);

}  // namespace limen
