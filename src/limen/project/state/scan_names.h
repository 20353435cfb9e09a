// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "limen/project/result/project_result.h"
#include "limen/project/state/project_node.h"

namespace limen {

/// A scan by its file, and which of the file's scans it is; `several`: the file holds others.
struct NumberedScan {
  std::string_view file;
  int index = 0;
  bool several = false;
};

/// What a scan is called: its file as the user wrote it, with " #0", " #1" ... for one of several in a file.
std::string scan_name(const NumberedScan& scan);
std::string scan_name(const ProjectScan& scan);

/// Those of `count` scans that a name fits: by their file and number, or else by their file's name without
/// folders. A name without a number fits all scans of its file.
std::vector<std::size_t> scans_called(const std::string& name, std::size_t count,
                                      const std::function<NumberedScan(std::size_t)>& scan);

/// The node that a name fits; -1: none, or several.
int node_called(const std::string& name, const std::vector<ProjectNode>& nodes,
                const std::vector<ProjectScan>& scans);

/// What a user calls the scan of a key of features; both must outlive it.
std::function<std::string(const std::string& key)> names_of_keys(const std::vector<ProjectNode>& nodes,
                                                                 const std::vector<ProjectScan>& scans);

}  // namespace limen
