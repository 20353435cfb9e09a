// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <csignal>
#include <mutex>
#include <string>

#include <pybind11/pybind11.h>

#include "limen/base/error.h"
#include "limen/base/progress.h"

namespace limen::python {

namespace py = pybind11;

/// Tells a Python function (stage, done, total) how the work goes: when a stage begins, and ten times a
/// second at most while it lasts. What the function throws stops the work and is thrown again by run().
class CallbackMonitor : public Monitor {
 public:
  explicit CallbackMonitor(py::object callback) : callback_(std::move(callback)) {}
  void begin_stage(std::string_view name) override;
  void advance(double done, double total) override;
  /// Throws what the function threw.
  void rethrow();

 private:
  void call(double done, double total);

  py::object callback_;
  std::mutex mutex_;
  std::string stage_;
  std::chrono::steady_clock::time_point told_;
  py::object failure_;  ///< of the function: what it threw
};

/// While it lives, an interrupt (Ctrl-C) cancels `monitor` as well as telling Python. Does nothing outside
/// Python's main thread, or where Python does not listen to interrupts.
class InterruptScope {
 public:
  explicit InterruptScope(Monitor& monitor);
  ~InterruptScope();
  InterruptScope(const InterruptScope&) = delete;
  InterruptScope& operator=(const InterruptScope&) = delete;

 private:
  bool installed_ = false;
  Monitor* outer_ = nullptr;
  struct sigaction before_ = {};
};

/// After work that was cancelled: raises what the user's function threw, or KeyboardInterrupt, else returns.
void raise_cause(CallbackMonitor& monitor);

/// Runs work(monitor) without the lock of the interpreter, and turns an interrupt into KeyboardInterrupt.
template <typename Work>
auto run(const py::object& progress, const Work& work) {
  CallbackMonitor monitor(progress);
  try {
    const InterruptScope interrupts(monitor);
    const py::gil_scoped_release released;
    const CancelScope scope(monitor);
    auto result = work(static_cast<Monitor&>(monitor));
    monitor.throw_if_cancelled();
    return result;
  } catch (const std::exception&) {
    if (monitor.cancelled()) raise_cause(monitor);
    throw;
  }
}

}  // namespace limen::python
