// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <numeric>
#include <vector>

#include "limen/base/progress.h"

namespace limen {

/// One stage's progress that several workers make at once: what each tells of its own share is added up.
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
