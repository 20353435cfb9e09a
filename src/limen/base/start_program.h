// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <string>
#include <vector>

namespace limen {

/// What execv and posix_spawn want of words: their addresses, and an end. Valid as long as the words are.
inline std::vector<char*> exec_pointers(std::vector<std::string>& words) {
  std::vector<char*> pointers;
  pointers.reserve(words.size() + 1);
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  return pointers;
}

/// The starter that takes this program through a loader of its own (scripts/bundle) and so has to be called
/// in its place; null: there is none, the program is called itself.
inline const char* program_starter() {
  const char* stated = std::getenv("LIMEN_PROGRAM_FILE");
  return stated != nullptr && *stated == '/' ? stated : nullptr;
}

}  // namespace limen
