// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "limen/extract/surface/surface_details.h"
#include "limen/geometry/rigid.h"
#include "limen/model/features.h"
#include "limen/sight/space_view.h"

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

/// One scan as registration sees it: its features and what its scanner knows of space.
struct ScanView {
  const Features* features = nullptr;
  const SpaceView* space = nullptr;  ///< what its scanner knows of space
  Eigen::AlignedBox3d reach = {};    ///< around its samples
  bool model = false;                ///< a building model: everything, of which the other saw a part
  bool mobile = false;               ///< seen from many places along a path
  bool knows_free = true;            ///< where the scanner stood is known, so that its rays tell what is free
  std::optional<Vector3d> station = {};  ///< of a static scan: where the (first) scanner stood
  /// All of them, of several scans known to one another. Null or empty: not known.
  const std::vector<Vector3d>* stations = nullptr;
  /// Of a model: its samples in runs, so that those within some reach are found without a look at each. Null:
  /// every sample is looked at.
  const SampleRuns* runs = nullptr;
  /// Flat pieces of what is in the room, of a static scan. Null: none are known.
  const std::vector<SurfaceDetail>* details = nullptr;
};

}  // namespace limen
