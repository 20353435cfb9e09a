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

std::string scan_name(const ProjectScan& scan) {
  return scan.index > 0 ? fmt::format("{} #{}", scan.file, scan.index) : scan.file;
}

int node_called(const std::string& name, const std::vector<ProjectNode>& nodes,
                const std::vector<ProjectScan>& scans) {
  const auto [file, index] = parts_of(name);
  for (const bool whole : {true, false}) {
    int found = -1;
    int count = 0;
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      const ProjectScan& scan = scans[nodes[n].scan];
      const std::string own = whole ? scan.file : std::filesystem::path(scan.file).filename().string();
      if (own != file || (index && scan.index != *index)) continue;
      found = static_cast<int>(n);
      ++count;
    }
    if (count == 1) return found;
  }
  return -1;
}

}  // namespace limen
