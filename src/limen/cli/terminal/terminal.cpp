// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/terminal/terminal.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "limen/base/error.h"
#include "limen/cli/terminal/progress_pipe.h"

namespace limen {
namespace {

constexpr std::chrono::milliseconds kTick{125};
constexpr std::chrono::milliseconds kLeastPause{100};

std::atomic<Monitor*> interrupted_monitor{nullptr};
static_assert(std::atomic<Monitor*>::is_always_lock_free && std::atomic<bool>::is_always_lock_free,
              "a signal handler may touch only lock-free atomics");

extern "C" void on_interrupt(int signal) {
  if (signal == SIGPIPE) return;
  Monitor* monitor = interrupted_monitor.load();
  if (monitor != nullptr && !monitor->cancelled()) {
    monitor->cancel();
    return;
  }
  // The second one: the system's own action ends a process that hangs.
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

std::string_view variable(const char* name) {
  const char* text = std::getenv(name);
  return text == nullptr ? std::string_view() : std::string_view(text);
}

/// By the variables that decide the locale, the strongest first.
bool speaks_utf8() {
  for (const char* name : {"LC_ALL", "LC_CTYPE", "LANG"}) {
    std::string locale(variable(name));
    if (locale.empty()) continue;
    std::transform(locale.begin(), locale.end(), locale.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    return locale.find("utf-8") != std::string::npos || locale.find("utf8") != std::string::npos;
  }
  return false;
}

int terminal_columns() {
  constexpr int kUnknown = 80;
  struct winsize size = {};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : kUnknown;
}

/// A process that was sent to the background does not write over what the user does meanwhile.
bool in_foreground() {
  const pid_t group = tcgetpgrp(STDERR_FILENO);
  return group < 0 || group == getpgrp();
}

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
  style_.columns = terminal_columns();
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
  const bool able = isatty(STDERR_FILENO) != 0 && variable("TERM") != "dumb";
  if (!able) return std::make_unique<NotingMonitor>();
  return std::make_unique<TerminalMonitor>(LineStyle{80, speaks_utf8()});
}

InterruptGuard::InterruptGuard(Monitor& monitor) {
  interrupted_monitor.store(&monitor);
  struct sigaction action = {};
  action.sa_handler = on_interrupt;
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;
  for (std::size_t k = 0; k < std::size(kSignals); ++k) {
    sigaction(kSignals[k], nullptr, &before_[k]);
    if (before_[k].sa_handler != SIG_IGN) sigaction(kSignals[k], &action, nullptr);
  }
}

InterruptGuard::~InterruptGuard() {
  for (std::size_t k = 0; k < std::size(kSignals); ++k) sigaction(kSignals[k], &before_[k], nullptr);
  interrupted_monitor.store(nullptr);
}

void print_out(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size()) cannot_print(errno);
}

void flush_out() {
  if (std::fflush(stdout) != 0) cannot_print(errno);
}

}  // namespace limen
