// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <string_view>

namespace limen {

/// What long work tells its caller, and how the caller stops it. The default hears nothing.
class Monitor {
 public:
  Monitor() = default;
  Monitor(const Monitor&) = delete;
  Monitor& operator=(const Monitor&) = delete;
  virtual ~Monitor() = default;

  /// A new stage begins, named in a user's words ("reading", "planes").
  virtual void begin_stage(std::string_view /*name*/) {}
  /// `done` of `total` units of the current stage; may be called from one thread at a time.
  virtual void advance(double /*done*/, double /*total*/) {}

  void cancel() noexcept { cancelled_.store(true, std::memory_order_relaxed); }
  [[nodiscard]] bool cancelled() const noexcept { return cancelled_.load(std::memory_order_relaxed); }
  /// Throws Error(Fault::cancelled) once cancel() was called.
  void throw_if_cancelled() const;

 private:
  std::atomic<bool> cancelled_{false};
};

/// A monitor nobody listens to.
Monitor& silent_monitor();

}  // namespace limen
