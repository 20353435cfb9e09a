// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace limen {

/// A program that hears lines on its stdin and answers with lines on its stdout. Its stdin ends with this
/// object, or with this process, however that ends.
class HelperProcess {
 public:
  /// What it says on stderr is added to the file `log`. Throws Error where no process can be made; a program
  /// that cannot be run ends at once.
  HelperProcess(const std::vector<std::string>& command, const std::string& log);
  /// Ends its stdin, waits for some seconds, and kills it where it goes on.
  ~HelperProcess();
  HelperProcess(const HelperProcess&) = delete;
  HelperProcess& operator=(const HelperProcess&) = delete;

  /// False where it hears nothing any more.
  bool say(const std::string& line);
  /// The next line, waiting for it so long; nothing where none came. See ended().
  std::optional<std::string> hear(int milliseconds);
  /// It closed its stdout and all of its lines were read.
  [[nodiscard]] bool ended() const { return ended_; }

 private:
  int id_ = -1;
  int socket_ = -1;
  std::string received_;
  bool ended_ = false;
};

}  // namespace limen
