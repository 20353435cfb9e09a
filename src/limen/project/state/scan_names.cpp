// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/state/scan_names.h"

#include <filesystem>

#include <fmt/format.h>

#include "limen/files/scan_in_file.h"

namespace limen {

std::string scan_name(const NumberedScan& scan) {
  return scan.several || scan.index > 0 ? fmt::format("{} #{}", scan.file, scan.index)
                                        : std::string(scan.file);
}

std::string scan_name(const ProjectScan& scan) {
  return scan_name(NumberedScan{scan.file, scan.index, scan.several});
}

std::vector<std::size_t> scans_called(const std::string& name, std::size_t count,
                                      const std::function<NumberedScan(std::size_t)>& scan) {
  const auto [file, index] = split_scan_name(name);
  std::vector<std::size_t> found;
  for (const bool whole : {true, false}) {
    for (std::size_t k = 0; k < count; ++k) {
      const NumberedScan other = scan(k);
      // A file's name may be that of a scan in it, as it was given to the project.
      const bool own = other.file == name;
      if (!own && index && static_cast<std::size_t>(other.index) != *index) continue;
      const bool fits =
          whole ? own || other.file == file : std::filesystem::path(other.file).filename() == file;
      if (fits) found.push_back(k);
    }
    if (!found.empty()) break;
  }
  return found;
}

int node_called(const std::string& name, const std::vector<ProjectNode>& nodes,
                const std::vector<ProjectScan>& scans) {
  const std::vector<std::size_t> found = scans_called(name, nodes.size(), [&](std::size_t n) {
    const ProjectScan& scan = scans[nodes[n].scan];
    return NumberedScan{scan.file, scan.index, scan.several};
  });
  return found.size() == 1 ? static_cast<int>(found.front()) : -1;
}

std::function<std::string(const std::string& key)> names_of_keys(const std::vector<ProjectNode>& nodes,
                                                                 const std::vector<ProjectScan>& scans) {
  return [&](const std::string& key) {
    for (const ProjectNode& node : nodes) {
      if (node.key == key) return scan_name(scans[node.scan]);
    }
    return key;
  };
}

}  // namespace limen
