// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

#include "limen/model/features.h"
#include "limen/sight/space_view.h"

namespace limen {

/// One scan as registration sees it: its features and what its scanner knows of space.
struct ScanView {
  const Features* features = nullptr;
  const SpaceView* space = nullptr;  ///< what its scanner knows of space
  Eigen::AlignedBox3d reach = {};    ///< around its samples
  bool model = false;                ///< a building model: everything, of which the other saw a part
  bool mobile = false;               ///< seen from many places along a path
};

}  // namespace limen
