// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <string>
#include <string_view>

#include <sys/ioctl.h>
#include <unistd.h>

#include "limen/cli/terminal/console.h"
#include "limen/cli/terminal/terminal.h"

namespace limen {
namespace {

constexpr std::array<int, 4> kSignals = {SIGINT, SIGTERM, SIGHUP, SIGPIPE};

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

}  // namespace

void prepare_program() {
  std::signal(SIGXFSZ, SIG_IGN);
}

bool draws_on_stderr() {
  return isatty(STDERR_FILENO) != 0 && variable("TERM") != "dumb";
}

bool console_is_utf8() {
  // The variables that decide the locale, the strongest first.
  for (const char* name : {"LC_ALL", "LC_CTYPE", "LANG"}) {
    std::string locale(variable(name));
    if (locale.empty()) continue;
    std::transform(locale.begin(), locale.end(), locale.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    return locale.find("utf-8") != std::string::npos || locale.find("utf8") != std::string::npos;
  }
  return false;
}

int console_columns() {
  constexpr int kUnknown = 80;
  struct winsize size = {};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : kUnknown;
}

bool in_foreground() {
  const pid_t group = tcgetpgrp(STDERR_FILENO);
  return group < 0 || group == getpgrp();
}

struct InterruptGuard::Before {
  std::array<struct sigaction, kSignals.size()> actions{};
};

InterruptGuard::InterruptGuard(Monitor& monitor) : before_(std::make_unique<Before>()) {
  interrupted_monitor.store(&monitor);
  struct sigaction action = {};
  action.sa_handler = on_interrupt;
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;
  for (std::size_t k = 0; k < kSignals.size(); ++k) {
    sigaction(kSignals[k], nullptr, &before_->actions[k]);
    if (before_->actions[k].sa_handler != SIG_IGN) sigaction(kSignals[k], &action, nullptr);
  }
}

InterruptGuard::~InterruptGuard() {
  for (std::size_t k = 0; k < kSignals.size(); ++k) sigaction(kSignals[k], &before_->actions[k], nullptr);
  interrupted_monitor.store(nullptr);
}

}  // namespace limen
