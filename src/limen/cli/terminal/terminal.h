// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <memory>
#include <mutex>
#include <string>

#include "limen/base/progress.h"
#include "limen/cli/terminal/progress_line.h"

namespace limen {

/// Shows the stage, how far it is and how long it will take in one line of the terminal on stderr, and wipes
/// it when it ends. Drawn about eight times a second by a thread of its own, so that it lives while the work
/// tells nothing, and telling costs the work nothing.
class TerminalMonitor : public Monitor {
 public:
  explicit TerminalMonitor(LineStyle style = {});
  ~TerminalMonitor() override;
  void begin_stage(std::string_view name) override;
  void advance(double done, double total) override;
  void set_unit(WorkUnit unit) override;
  void note(std::string_view text) override;
  /// Takes the line away, before something else is printed, until the next stage begins.
  void wipe();
  /// Prints lines on stderr above the progress line.
  void print(std::string_view text);

 private:
  using Clock = std::chrono::steady_clock;
  void draw();  // these three: mutex_ is held
  void take_away();
  [[nodiscard]] double seconds_since_begin() const;

  std::mutex mutex_;
  LineStyle style_;
  ProgressState state_;
  RemainingTime remaining_;
  Clock::time_point begun_;
  Clock::time_point last_drawn_;
  bool active_ = false;
  bool line_open_ = false;
  std::unique_ptr<Ticker> ticker_;  // last: it ends before the rest goes
};

/// One that tells another program where that asked for it (see progress_pipe.h), else a TerminalMonitor where
/// stderr is a terminal that can move its cursor and `quiet` is false, else one that shows no progress. All
/// print notes on stderr unless `quiet`.
std::unique_ptr<Monitor> make_monitor(bool quiet);

/// While it lives, the first SIGINT, SIGTERM or SIGHUP cancels `monitor`; a second one ends the process at
/// once. Signals that were ignored (nohup) stay so. SIGPIPE is caught but does nothing: who writes is
/// informed by its write.
class InterruptGuard {
 public:
  explicit InterruptGuard(Monitor& monitor);
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

 private:
  struct Before;
  std::unique_ptr<Before> before_;
};

/// Thrown where the reader of stdout is gone: the program then ends without a word, as SIGPIPE would end it.
struct ReaderGone {};

/// Writes all of `text` to stdout. Throws ReaderGone, or Error where it cannot be written.
void print_out(std::string_view text);
/// Writes what stdout still holds back; errors as above.
void flush_out();

}  // namespace limen
