// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "limen/base/random.h"
#include "limen/geometry/rigid.h"

namespace limen {

/// A slow, smooth error of a trajectory with zero mean over its duration: a few waves per axis.
class Drift {
 public:
  Drift(double sigma, double begin_s, double end_s, RandomStream& random) : begin_(begin_s), end_(end_s) {
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
  struct Wave {
    Vector3d amplitude = Vector3d::Zero();
    Vector3d phase = Vector3d::Zero();
  };
  std::array<Wave, kWaves> waves_;
  double begin_;
  double end_;
};

}  // namespace limen
