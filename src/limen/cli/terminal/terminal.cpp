// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/terminal/terminal.h"

#include <cerrno>
#include <cstdio>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/cli/terminal/console.h"
#include "limen/cli/terminal/progress_pipe.h"

namespace limen {
namespace {

constexpr std::chrono::milliseconds kTick{125};
constexpr std::chrono::milliseconds kLeastPause{100};

/// A terminal that is gone takes nothing, and that is no fault of the work.
void print_quietly(std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

std::string line_of_note(std::string_view text) {
  return fmt::format("limen: {}\n", text);
}

/// Shows no progress.
class NotingMonitor : public Monitor {
 public:
  void note(std::string_view text) override { print_quietly(line_of_note(text)); }
};

[[noreturn]] void cannot_print(int error_number) {
  if (error_number == EPIPE) throw ReaderGone{};
  throw Error("cannot be written", "standard output", "free some room, or read all of it");
}

}  // namespace

TerminalMonitor::TerminalMonitor(LineStyle style) : style_(style) {
  ticker_ = std::make_unique<Ticker>(kTick, [this] {
    const std::scoped_lock lock(mutex_);
    draw();
  });
}

TerminalMonitor::~TerminalMonitor() {
  ticker_.reset();
  wipe();
}

void TerminalMonitor::wipe() {
  const std::scoped_lock lock(mutex_);
  active_ = false;
  take_away();
}

void TerminalMonitor::print(std::string_view text) {
  const std::scoped_lock lock(mutex_);
  take_away();
  print_quietly(text);
}

void TerminalMonitor::note(std::string_view text) {
  print(line_of_note(text));
}

void TerminalMonitor::begin_stage(std::string_view name) {
  const std::scoped_lock lock(mutex_);
  active_ = true;
  state_ = {};
  state_.stage = name;
  remaining_ = {};
  begun_ = Clock::now();
  draw();
}

void TerminalMonitor::advance(double done, double total) {
  const std::scoped_lock lock(mutex_);
  // Work that begins anew within a stage lets the bar stand rather than jump back.
  if (total > 0.0 && state_.total > 0.0 && done / total < state_.done / state_.total) return;
  state_.done = done;
  state_.total = total;
}

void TerminalMonitor::set_unit(WorkUnit unit) {
  const std::scoped_lock lock(mutex_);
  state_.unit = unit;
}

double TerminalMonitor::seconds_since_begin() const {
  return std::chrono::duration<double>(Clock::now() - begun_).count();
}

void TerminalMonitor::take_away() {
  if (line_open_) print_quietly("\r\x1b[K");
  line_open_ = false;
}

void TerminalMonitor::draw() {
  const auto now = Clock::now();
  if (!active_ || now - last_drawn_ < kLeastPause) return;
  last_drawn_ = now;
  if (!in_foreground()) return;
  style_.columns = console_columns();
  ProgressState shown = state_;
  shown.elapsed_s = seconds_since_begin();
  shown.remaining_s = remaining_.update(shown.elapsed_s, state_.done, state_.total);
  if (cancelled()) shown = {"stopping", WorkUnit::steps, 0.0, 0.0, shown.elapsed_s, {}};
  line_open_ = true;
  print_quietly(fmt::format("\r{}\x1b[K", progress_line(shown, style_)));
}

std::unique_ptr<Monitor> make_monitor(bool quiet) {
  if (std::unique_ptr<Monitor> pipe = pipe_monitor()) return pipe;
  if (quiet) return std::make_unique<Monitor>();
  if (!draws_on_stderr()) return std::make_unique<NotingMonitor>();
  return std::make_unique<TerminalMonitor>(LineStyle{80, console_is_utf8()});
}

void print_out(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size()) cannot_print(errno);
}

void flush_out() {
  if (std::fflush(stdout) != 0) cannot_print(errno);
}

}  // namespace limen
