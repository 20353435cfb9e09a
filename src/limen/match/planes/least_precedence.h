// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <functional>
#include <mutex>
#include <vector>

#include "limen/model/pose_candidate.h"

namespace limen {

/// The precedence that a pose needs to be among the best so many of all rotations done so far. Which those
/// are depends on the threads, what is left out by it does not: nothing below it can be among the best in the
/// end.
class LeastPrecedence {
 public:
  explicit LeastPrecedence(std::size_t most) : most_(most) {}

  [[nodiscard]] double value() const { return value_.load(std::memory_order_relaxed); }

  void add(const std::vector<PoseCandidate>& poses) {
    const std::scoped_lock lock(mutex_);
    for (const PoseCandidate& pose : poses) best_.push_back(pose.precedence);
    if (best_.size() < most_) return;
    const auto last = best_.begin() + static_cast<std::ptrdiff_t>(most_ - 1);
    std::nth_element(best_.begin(), last, best_.end(), std::greater<>());
    // A little less: poses that are equal to it may still be among them.
    value_.store(*last * (1.0 - 1e-9), std::memory_order_relaxed);
    best_.resize(most_);
  }

 private:
  std::size_t most_;
  std::mutex mutex_;
  std::vector<double> best_;
  std::atomic<double> value_{0.0};
};

}  // namespace limen
