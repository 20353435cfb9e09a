// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "limen/base/random.h"
#include "limen/geometry/rigid.h"

namespace limen {

/// How a trajectory errs along its way.
enum class DriftKind {
  waves,  ///< a few waves: smooth
  walk    ///< a random walk, as of a receiver and an inertial unit under way
};

/// A slow error of a trajectory with zero mean over its duration; `sigma` of it per axis.
class Drift {
 public:
  Drift(double sigma, double begin_s, double end_s, RandomStream& random, DriftKind kind = DriftKind::waves)
      : begin_(begin_s), end_(end_s) {
    if (kind == DriftKind::walk) {
      walk(sigma, random);
      return;
    }
    for (Wave& wave : waves_) {
      for (int axis = 0; axis < 3; ++axis) {
        wave.amplitude[axis] = sigma * random.normal() / std::sqrt(0.5 * kWaves);
        wave.phase[axis] = random.uniform(0.0, 2.0 * std::numbers::pi);
      }
    }
  }

  [[nodiscard]] Vector3d at(double time_s) const {
    Vector3d sum = Vector3d::Zero();
    const double share = (time_s - begin_) / std::max(1e-9, end_ - begin_);
    if (!steps_.empty()) {
      const double place = std::clamp(share, 0.0, 1.0) * kSteps;
      const auto step = std::min(steps_.size() - 2, static_cast<std::size_t>(place));
      const double part = place - static_cast<double>(step);
      return (1.0 - part) * steps_[step] + part * steps_[step + 1];
    }
    for (int k = 0; k < kWaves; ++k)
      for (int axis = 0; axis < 3; ++axis) {
        const Wave& wave = waves_[static_cast<std::size_t>(k)];
        // Whole numbers of waves: the mean over the drive is zero.
        sum[axis] +=
            wave.amplitude[axis] * std::sin(2.0 * std::numbers::pi * (k + 1) * share + wave.phase[axis]);
      }
    return sum;
  }

 private:
  static constexpr int kWaves = 3;
  static constexpr int kSteps = 400;

  /// Of n steps of variance q each it strays from its mean by n q / 6, squared.
  void walk(double sigma, RandomStream& random) {
    const double step = sigma * std::sqrt(6.0 / kSteps);
    steps_.push_back(Vector3d::Zero());
    Vector3d sum = Vector3d::Zero();
    for (int k = 0; k < kSteps; ++k) {
      Vector3d next = steps_.back();
      for (int axis = 0; axis < 3; ++axis) next[axis] += step * random.normal();
      steps_.push_back(next);
      sum += next;
    }
    for (Vector3d& place : steps_) place -= sum / kSteps;
  }

  struct Wave {
    Vector3d amplitude = Vector3d::Zero();
    Vector3d phase = Vector3d::Zero();
  };
  std::array<Wave, kWaves> waves_;
  std::vector<Vector3d> steps_;
  double begin_;
  double end_;
};

}  // namespace limen
