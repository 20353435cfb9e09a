// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/geometry/plane.h"

namespace limen {

/// A large plane of a scan, found quickly.
struct FramePlane {
  Plane plane;           ///< about the points' origin, the normal's sign open
  double area_m2 = 0.0;  ///< of the cubes that voted for it, about
  Vector3d middle = Vector3d::Zero();
};

/// Large planes of a cloud of some 100 000 points, largest first: cubes whose points lie in a plane vote for
/// directions, then for offsets; every plane is then settled on the points by a robust fit, whose result does
/// not depend on where the cubes lay. So a moved or turned cloud gives the same planes.
std::vector<FramePlane> frame_planes(const std::vector<Vector3d>& points);

}  // namespace limen
