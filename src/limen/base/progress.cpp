// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/base/progress.h"

#include "limen/base/error.h"

namespace limen {
namespace {

thread_local const Monitor* current_monitor = nullptr;

}  // namespace

void Monitor::throw_if_cancelled() const {
  if (cancelled()) throw Error("interrupted", "", "nothing was written", Fault::cancelled);
}

CancelScope::CancelScope(const Monitor* monitor) : outer_(current_monitor) {
  current_monitor = monitor;
}

CancelScope::~CancelScope() {
  current_monitor = outer_;
}

const Monitor* CancelScope::current() noexcept {
  return current_monitor;
}

void CancelScope::check() {
  if (current_monitor != nullptr) current_monitor->throw_if_cancelled();
}

Monitor& silent_monitor() {
  static Monitor monitor;
  return monitor;
}

}  // namespace limen
