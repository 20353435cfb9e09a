// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <cstdio>

#include <windows.h>

#include "limen/base/system.h"
#include "limen/cli/terminal/console.h"
#include "limen/cli/terminal/terminal.h"

namespace limen {
namespace {

std::atomic<Monitor*> interrupted_monitor{nullptr};

/// Ctrl-C, Ctrl-Break, or a window that is closed: the first cancels, a second ends the process.
BOOL WINAPI on_interrupt(DWORD /*event*/) {
  Monitor* monitor = interrupted_monitor.load();
  if (monitor == nullptr || monitor->cancelled()) return FALSE;
  monitor->cancel();
  return TRUE;
}

}  // namespace

void prepare_program() {
  SetConsoleOutputCP(CP_UTF8);
  keep_bytes(_fileno(stdout));
  keep_bytes(_fileno(stderr));
}

bool draws_on_stderr() {
  HANDLE console = GetStdHandle(STD_ERROR_HANDLE);
  DWORD mode = 0;
  return GetConsoleMode(console, &mode) != 0 &&
         SetConsoleMode(console, mode | ENABLE_VIRTUAL_TERMINAL_PROCESSING) != 0;
}

bool console_is_utf8() {
  return GetConsoleOutputCP() == CP_UTF8;
}

int console_columns() {
  constexpr int kUnknown = 80;
  CONSOLE_SCREEN_BUFFER_INFO buffer{};
  if (GetConsoleScreenBufferInfo(GetStdHandle(STD_ERROR_HANDLE), &buffer) == 0) return kUnknown;
  return buffer.srWindow.Right - buffer.srWindow.Left + 1;
}

bool in_foreground() {
  return true;
}

struct InterruptGuard::Before {};

InterruptGuard::InterruptGuard(Monitor& monitor) {
  interrupted_monitor.store(&monitor);
  SetConsoleCtrlHandler(on_interrupt, TRUE);
}

InterruptGuard::~InterruptGuard() {
  SetConsoleCtrlHandler(on_interrupt, FALSE);
  interrupted_monitor.store(nullptr);
}

}  // namespace limen
