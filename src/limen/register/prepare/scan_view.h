// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "limen/extract/surface/surface_details.h"
#include "limen/model/features.h"
#include "limen/register/prepare/sample_runs.h"
#include "limen/sight/space_view.h"

namespace limen {

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
