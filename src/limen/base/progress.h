// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <mutex>
#include <numeric>
#include <string_view>
#include <vector>

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

/// One part of a stage, for work that counts its own progress from nothing to all: tells it to `whole` as the
/// piece from `begin` to `end` of 1. Stages that begin within it are not shown. A cancelled `whole` cancels
/// it at its next advance(); use it within a CancelScope of `whole`, which can be cancelled at any time.
class StagePart : public Monitor {
 public:
  StagePart(Monitor& whole, double begin, double end) : whole_(whole), begin_(begin), end_(end) {
    advance(0.0, 1.0);
  }

  void advance(double done, double total) override {
    if (whole_.cancelled()) cancel();
    if (total > 0.0) whole_.advance(begin_ + (end_ - begin_) * done / total, 1.0);
  }

 private:
  Monitor& whole_;
  double begin_;
  double end_;
};

/// One stage's progress that several workers make at once: what each reports of its own share is added up.
class StageShares {
 public:
  StageShares(Monitor& whole, std::size_t workers) : whole_(whole), done_(workers, 0.0) {
    for (std::size_t k = 0; k < workers; ++k) workers_.push_back(std::make_unique<Worker>(*this, k));
  }

  /// The monitor of one worker; lives as long as this.
  [[nodiscard]] Monitor& worker(std::size_t k) { return *workers_[k]; }

 private:
  class Worker : public Monitor {
   public:
    Worker(StageShares& all, std::size_t place) : all_(all), place_(place) {}
    void advance(double done, double total) override {
      if (all_.whole_.cancelled()) cancel();
      if (total > 0.0) all_.advance(place_, done / total);
    }

   private:
    StageShares& all_;
    std::size_t place_;
  };

  void advance(std::size_t place, double share) {
    const std::scoped_lock lock(mutex_);
    done_[place] = share;
    whole_.advance(std::accumulate(done_.begin(), done_.end(), 0.0), static_cast<double>(done_.size()));
  }

  Monitor& whole_;
  std::mutex mutex_;
  std::vector<double> done_;
  std::vector<std::unique_ptr<Worker>> workers_;
};

}  // namespace limen
