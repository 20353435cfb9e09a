// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/inputs/scan_list.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "limen/base/error.h"
#include "limen/base/text.h"
#include "limen/files/readable.h"

namespace limen {
namespace {

bool is_control(char c) {
  return (static_cast<unsigned char>(c) < 0x20U && c != '\t') || c == '\x7f';
}

}  // namespace

std::vector<std::string> names_in_list(const std::string& path) {
  constexpr const char* kListRemedy = "give a text file with the name of a scan on each line";
  require_readable(path, kListRemedy, "list");
  std::ifstream stream(path);
  std::vector<std::string> names;
  bool first = true;
  for (std::string line; std::getline(stream, line); first = false) {
    const std::string_view text = trimmed(first ? without_byte_order_mark(line) : line);
    if (!is_utf8(text) || std::any_of(text.begin(), text.end(), is_control))
      throw Error("is not a list of names: it contains bytes that are not text", path, kListRemedy);
    if (text.empty() || text.front() == '#') continue;
    const std::filesystem::path name(text);
    names.push_back((name.is_absolute() ? name : std::filesystem::path(path).parent_path() / name).string());
  }
  return names;
}

}  // namespace limen
