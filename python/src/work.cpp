// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "work.h"

#include <atomic>

namespace limen::python {
namespace {

std::atomic<Monitor*> interrupted_monitor{nullptr};
std::atomic<void (*)(int)> pythons_handler{nullptr};

extern "C" void on_interrupt(int signal) {
  if (Monitor* monitor = interrupted_monitor.load()) monitor->cancel();
  if (void (*handler)(int) = pythons_handler.load()) handler(signal);
}

bool in_main_thread() {
  const py::module_ threading = py::module_::import("threading");
  return threading.attr("current_thread")().is(threading.attr("main_thread")());
}

}  // namespace

void CallbackMonitor::begin_stage(std::string_view name) {
  if (callback_.is_none()) return;
  const std::scoped_lock lock(mutex_);
  stage_ = name;
  call(0.0, 0.0);
}

void CallbackMonitor::advance(double done, double total) {
  if (callback_.is_none()) return;
  const std::scoped_lock lock(mutex_);
  if (std::chrono::steady_clock::now() - told_ < std::chrono::milliseconds(100)) return;
  call(done, total);
}

void CallbackMonitor::call(double done, double total) {
  told_ = std::chrono::steady_clock::now();
  const py::gil_scoped_acquire locked;
  if (failure_) return;
  try {
    callback_(stage_, done, total);
  } catch (py::error_already_set& error) {
    failure_ = error.value();
    cancel();
  }
}

void CallbackMonitor::rethrow() {
  if (!failure_) return;
  PyErr_SetObject(reinterpret_cast<PyObject*>(Py_TYPE(failure_.ptr())), failure_.ptr());
  throw py::error_already_set();
}

InterruptScope::InterruptScope(Monitor& monitor) {
  if (!in_main_thread()) return;
  sigaction(SIGINT, nullptr, &before_);
  if (before_.sa_handler == SIG_DFL || before_.sa_handler == SIG_IGN) return;
  installed_ = true;
  outer_ = interrupted_monitor.exchange(&monitor);
  if (before_.sa_handler == on_interrupt) return;  // a function that shows progress has started other work
  pythons_handler.store(before_.sa_handler);
  struct sigaction action = {};
  action.sa_handler = on_interrupt;
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;
  sigaction(SIGINT, &action, nullptr);
}

InterruptScope::~InterruptScope() {
  if (!installed_) return;
  if (before_.sa_handler != on_interrupt) sigaction(SIGINT, &before_, nullptr);
  interrupted_monitor.store(outer_);
}

void raise_cause(CallbackMonitor& monitor) {
  monitor.rethrow();
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

}  // namespace limen::python
