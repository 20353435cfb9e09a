// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <string_view>

namespace limen {

/// What the units of a stage are: points and bytes have a rate, steps have none.
enum class WorkUnit { steps, points, bytes };

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
  /// What advance() counts until the next stage begins; steps where nothing is said.
  virtual void set_unit(WorkUnit /*unit*/) {}
  /// A sentence for the user that is part of no result; may be called from any thread.
  virtual void note(std::string_view /*text*/) {}

  void cancel() noexcept { cancelled_.store(true, std::memory_order_relaxed); }
  [[nodiscard]] bool cancelled() const noexcept { return cancelled_.load(std::memory_order_relaxed); }
  /// Throws Error(Fault::cancelled) once cancel() was called.
  void throw_if_cancelled() const;

 private:
  std::atomic<bool> cancelled_{false};
};

/// While it lives, everything that the calling thread does, and the pieces of its parallel work, can be
/// stopped through `monitor`: parallel_for looks before each piece, and so do long loops that have no monitor
/// of their own, by check(). The innermost scope counts.
class CancelScope {
 public:
  explicit CancelScope(const Monitor& monitor) : CancelScope(&monitor) {}
  /// The scope of another thread, or none.
  explicit CancelScope(const Monitor* monitor);
  ~CancelScope();
  CancelScope(const CancelScope&) = delete;
  CancelScope& operator=(const CancelScope&) = delete;

  /// The calling thread's; null where there is none.
  static const Monitor* current() noexcept;
  /// Throws Error(Fault::cancelled) once the scope's monitor was cancelled. Costs about a nanosecond.
  static void check();

 private:
  const Monitor* outer_;
};

/// A monitor nobody listens to.
Monitor& silent_monitor();

}  // namespace limen
