// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/scan_names.h"

#include <filesystem>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "limen/files/text_numbers.h"

namespace limen {
namespace {

/// A scan's name in two parts: the file, and which of its scans.
std::pair<std::string, std::optional<int>> parts_of(const std::string& name) {
  const std::size_t mark = name.rfind('#');
  if (mark == std::string::npos) return {name, {}};
  const std::optional<std::size_t> index = parse_count(std::string_view(name).substr(mark + 1));
  if (!index) return {name, {}};
  std::string file = name.substr(0, mark);
  while (!file.empty() && file.back() == ' ') file.pop_back();
  return {file, static_cast<int>(*index)};
}

}  // namespace

std::string scan_name(const NumberedScan& scan) {
  return scan.several || scan.index > 0 ? fmt::format("{} #{}", scan.file, scan.index)
                                        : std::string(scan.file);
}

std::string scan_name(const ProjectScan& scan) {
  return scan_name(NumberedScan{scan.file, scan.index, scan.several});
}

std::vector<std::size_t> scans_called(const std::string& name, std::size_t count,
                                      const std::function<NumberedScan(std::size_t)>& scan) {
  const auto [file, index] = parts_of(name);
  std::vector<std::size_t> found;
  for (const bool whole : {true, false}) {
    for (std::size_t k = 0; k < count; ++k) {
      const NumberedScan other = scan(k);
      if (index && other.index != *index) continue;
      const bool fits = whole ? other.file == file : std::filesystem::path(other.file).filename() == file;
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
