// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace limen {

/// A run of this same program in a process of its own, which does not outlive this one, whatever happens.
class Child {
 public:
  /// Starts `limen ARGUMENTS...` in `folder`. Throws Error where no process can be made.
  Child(const std::vector<std::string>& arguments, const std::filesystem::path& folder);
  /// Kills it where it still runs, with what it started.
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  /// Takes what it has said since, without waiting.
  void listen();
  /// Asks it to end, as Ctrl-C would; a second time it is killed.
  void stop();
  /// Its exit status once it has ended, 128 + the signal where it was killed; waits for nothing.
  std::optional<int> ended();

  [[nodiscard]] const std::string& said() const { return said_; }  ///< the last of what it printed
  [[nodiscard]] const std::string& stage() const { return stage_; }
  [[nodiscard]] double share() const { return share_; }  ///< of the stage, 0 to 1; below 0: not known
  /// What tells that listen() has something to hear; closed ends are left out.
  [[nodiscard]] std::vector<int> ears() const;

 private:
  void hear_progress();

  pid_t id_ = -1;
  int output_ = -1;
  int progress_ = -1;
  bool asked_ = false;
  std::optional<int> status_;
  std::string said_;
  std::string unread_;
  std::string stage_;
  double share_ = -1.0;
};

}  // namespace limen
