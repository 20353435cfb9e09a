// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/model/method.h"
#include "limen/model/scan.h"
#include "limen/model/scanner_place.h"
#include "limen/register/frame/frame_planes.h"

namespace limen {

/// A direction against gravity, and whether the data (or the user) tell it clearly.
struct ScanUp {
  Vector3d up = Vector3d::UnitZ();
  bool clear = false;
  bool sure = false;  ///< so clear that no other way need be tried
};

/// Up of a scan whose large planes are `planes`. `sample`: an even share of its points, with the place of its
/// scanner where that is known; `place`: how much is known of that.
ScanUp find_up(const Scan& sample, const std::vector<FramePlane>& planes, Gravity gravity,
               const ScannerPlace& place);

/// `up` settled on the planes: as well as can be across the floors and along the walls.
Vector3d settled_up(const Vector3d& up, const std::vector<FramePlane>& planes, bool mobile);

}  // namespace limen
