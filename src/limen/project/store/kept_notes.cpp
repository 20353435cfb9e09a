// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/store/kept_notes.h"

#include <string_view>

#include <fmt/format.h>

namespace limen {
namespace {

/// In no name that a reader tells: control characters are not printable.
constexpr char kMark = '\x1f';

/// "NAME: ...", "NAME, scan 2 ..." or "NAME was ...", not a word that begins so.
bool begins_with_name(std::string_view note, std::string_view name) {
  constexpr std::string_view kAfterName = ":, ";
  return !name.empty() && note.size() > name.size() && note.starts_with(name) &&
         kAfterName.find(note[name.size()]) != std::string_view::npos;
}

}  // namespace

std::string name_mark(std::size_t number) {
  return fmt::format("{}{}{}", kMark, number, kMark);
}

std::vector<std::string> without_name(std::vector<std::string> notes, const std::string& name) {
  for (std::string& note : notes) {
    if (begins_with_name(note, name)) note.replace(0, name.size(), name_mark(0));
  }
  return notes;
}

std::vector<std::string> with_names(std::vector<std::string> notes, const std::vector<std::string>& names) {
  for (std::string& note : notes) {
    for (std::size_t k = 0; k < names.size(); ++k) {
      const std::string mark = name_mark(k);
      for (std::size_t at = note.find(mark); at != std::string::npos;
           at = note.find(mark, at + names[k].size()))
        note.replace(at, mark.size(), names[k]);
    }
  }
  return notes;
}

}  // namespace limen
