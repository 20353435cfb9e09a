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
/// some of a run lie in a box is mostly decided by the ball alone.
class SampleRuns {
 public:
  SampleRuns() = default;
  explicit SampleRuns(const std::vector<SurfaceSample>& samples);

  /// Samples that lie in a box: every `stride`-th.
  struct Within {
    std::vector<std::uint32_t> indices;
    std::size_t stride = 1;
  };
  /// The samples that lie in `box` once moved, in their order: exactly those for which
  /// box.contains(box_from_sample * mean); evenly thinned to no more than `most` (0: all). `samples`: those
  /// the runs were made of.
  [[nodiscard]] Within within(const Eigen::AlignedBox3d& box, const Rigid3& box_from_sample,
                              const std::vector<SurfaceSample>& samples, std::size_t most = 0) const;

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
