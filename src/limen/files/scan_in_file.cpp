// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/files/scan_in_file.h"

#include <filesystem>
#include <string_view>

#include "limen/files/text_numbers.h"

namespace limen {

ScanInFile split_scan_name(const std::string& name) {
  const std::size_t mark = name.rfind('#');
  if (mark == std::string::npos) return {name, {}};
  const std::optional<std::size_t> index = parse_count(std::string_view(name).substr(mark + 1));
  if (!index) return {name, {}};
  std::string file = name.substr(0, mark);
  while (!file.empty() && file.back() == ' ') file.pop_back();
  return {file, index};
}

ScanInFile scan_in_file(const std::string& name) {
  const ScanInFile parts = split_scan_name(name);
  std::error_code ignored;
  if (!parts.index || std::filesystem::exists(name, ignored)) return {name, {}};
  return std::filesystem::is_regular_file(parts.file, ignored) ? parts : ScanInFile{name, {}};
}

std::string file_of_scan(const std::string& name) {
  return scan_in_file(name).file;
}

}  // namespace limen
