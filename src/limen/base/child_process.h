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

/// What a started program gets, and what it may take from its first instruction on.
struct ChildOptions {
  int input = -1;             ///< a descriptor, its stdin; without one there is nothing to read
  int output = -1;            ///< its stdout; without one it goes nowhere, as its stderr does
  double memory_bytes = 0.0;  ///< address space; 0: no bound
  double cpu_s = 0.0;         ///< computing time; 0: no bound
};

/// How a program ended.
struct ChildEnd {
  bool by_itself = false;
  int status = 0;   ///< its exit status, where it ended by itself
  std::string how;  ///< "was ended by signal 11 (Segmentation fault)", for messages
};

/// A program that was started: silent, not reached by the terminal's interrupt, and killed with this object
/// or this process, however that ends, and what it started with it.
class ChildProcess {
 public:
  /// The exit status of what cannot be run at all.
  static constexpr int kNotStarted = 127;

  ChildProcess(const std::vector<std::string>& words, const ChildOptions& options);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Empty, or why there is no process.
  [[nodiscard]] const std::string& problem() const { return problem_; }
  void kill();
  /// Whether it has ended; does not wait.
  bool ended();
  ChildEnd wait();

 private:
  struct Handles;
  Handles* handles_;
  std::string problem_;
};

}  // namespace limen
