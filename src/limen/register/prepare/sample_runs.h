// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "limen/geometry/rigid.h"
#include "limen/model/features.h"

namespace limen {

/// Samples in runs of neighbours as they follow one another, each run within a ball: whether all, none or
/// some of a run lie in a box is mostly told by the ball alone.
class SampleRuns {
 public:
  SampleRuns() = default;
  explicit SampleRuns(const std::vector<SurfaceSample>& samples);

  /// The samples that lie in `box` once moved, in their order: exactly those for which
  /// box.contains(box_from_sample * mean). `samples`: those the runs were made of.
  [[nodiscard]] std::vector<std::uint32_t> within(const Eigen::AlignedBox3d& box,
                                                  const Rigid3& box_from_sample,
                                                  const std::vector<SurfaceSample>& samples) const;

 private:
  struct Run {
    std::uint32_t begin = 0;
    std::uint32_t end = 0;
    Vector3d centre = Vector3d::Zero();
    double radius_m = 0.0;
  };
  std::vector<Run> runs_;
  std::vector<Run> groups_;  ///< runs, so many that follow one another, in a ball together
};

}  // namespace limen
