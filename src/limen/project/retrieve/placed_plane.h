// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <optional>

#include "limen/geometry/rigid.h"

namespace limen {

/// A plane of a scan in the axes of the part that the scan belongs to. Metres.
struct PlacedPlane {
  Vector3d middle = Vector3d::Zero();
  Vector3d normal = Vector3d::UnitZ();
  Vector3d along = Vector3d::Zero();   ///< half its extent in one direction, level where it is a wall
  Vector3d across = Vector3d::Zero();  ///< half its extent in the other
  double area_m2 = 0.0;
  bool oriented = false;            ///< the normal points to the side it was seen from
  std::optional<Vector3d> scanner;  ///< the scanner position that saw it
};

/// Whether a normal is that of a wall: it rises no more than 10 degrees.
inline bool is_wall(const Vector3d& normal) {
  constexpr double kSlope = 0.17;
  return std::abs(normal.z()) <= kSlope;
}

}  // namespace limen
