// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <memory>
#include <string>

#include "limen/base/progress.h"

namespace limen {

/// Shows the stage and its percentage in one line of the terminal on stderr, and wipes it when it ends.
class TerminalMonitor : public Monitor {
 public:
  TerminalMonitor() = default;
  ~TerminalMonitor() override;
  void begin_stage(std::string_view name) override;
  void advance(double done, double total) override;
  /// Takes the line away, before something else is printed.
  void wipe();

 private:
  void draw(int percent);

  std::string stage_;
  int shown_percent_ = -1;
  std::chrono::steady_clock::time_point last_drawn_;
  bool line_open_ = false;
};

/// A TerminalMonitor where stderr is a terminal and `quiet` is false, else one that shows nothing.
std::unique_ptr<Monitor> make_monitor(bool quiet);

/// While it lives, the first SIGINT or SIGTERM cancels `monitor`; a second one ends the process at once.
class InterruptGuard {
 public:
  explicit InterruptGuard(Monitor& monitor);
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;
};

}  // namespace limen
