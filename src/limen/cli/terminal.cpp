// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/terminal.h"

#include <atomic>
#include <csignal>

#include <fmt/format.h>
#include <unistd.h>

namespace limen {
namespace {

std::atomic<Monitor*> interrupted_monitor{nullptr};
static_assert(std::atomic<Monitor*>::is_always_lock_free && std::atomic<bool>::is_always_lock_free,
              "a signal handler may touch only lock-free atomics");

extern "C" void on_interrupt(int /*signal*/) {
  if (Monitor* monitor = interrupted_monitor.load()) monitor->cancel();
}

void install(void (*handler)(int)) {
  struct sigaction action = {};
  action.sa_handler = handler;
  sigemptyset(&action.sa_mask);
  // After the first signal the system's own action is back: a second one ends a process that hangs.
  action.sa_flags = static_cast<int>(SA_RESETHAND) | SA_RESTART;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

}  // namespace

TerminalMonitor::~TerminalMonitor() {
  wipe();
}

void TerminalMonitor::wipe() {
  if (line_open_) fmt::print(stderr, "\r\x1b[K");
  line_open_ = false;
}

void TerminalMonitor::begin_stage(std::string_view name) {
  stage_ = name;
  shown_percent_ = -1;
  draw(-1);
}

void TerminalMonitor::advance(double done, double total) {
  const int percent = total > 0 ? static_cast<int>(100.0 * done / total) : 0;
  const auto now = std::chrono::steady_clock::now();
  if (percent == shown_percent_ || now - last_drawn_ < std::chrono::milliseconds(100)) return;
  shown_percent_ = percent;
  last_drawn_ = now;
  draw(percent);
}

void TerminalMonitor::draw(int percent) {
  line_open_ = true;
  if (percent < 0) {
    fmt::print(stderr, "\r\x1b[K{} ...", stage_);
  } else {
    fmt::print(stderr, "\r\x1b[K{} ... {} %", stage_, percent);
  }
}

std::unique_ptr<Monitor> make_monitor(bool quiet) {
  if (!quiet && isatty(STDERR_FILENO) != 0) return std::make_unique<TerminalMonitor>();
  return std::make_unique<Monitor>();
}

InterruptGuard::InterruptGuard(Monitor& monitor) {
  interrupted_monitor.store(&monitor);
  install(on_interrupt);
}

InterruptGuard::~InterruptGuard() {
  install(SIG_DFL);
  interrupted_monitor.store(nullptr);
}

}  // namespace limen
