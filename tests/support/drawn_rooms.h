// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/project/store/scan_digest.h"

namespace limen {

/// A rectangle of tiles, `wide` x `high` metres about `middle`, seen from where its normal points
/// to.
inline PlaneDigest rectangle(const Vector3d& middle, const Vector3d& normal, double wide, double high) {
  PlaneDigest digest;
  digest.plane = {normal, normal.dot(middle)};
  digest.centroid = middle;
  digest.area_m2 = wide * high;
  digest.oriented = true;
  const Vector3d up = std::abs(normal.z()) > 0.5 ? Vector3d::UnitX() : Vector3d::UnitZ();
  const Vector3d along = up.cross(normal).normalized();
  for (double u = -0.5 * wide + 0.05; u < 0.5 * wide; u += 0.1)
    for (double v = -0.5 * high + 0.05; v < 0.5 * high; v += 0.1) digest.moments.add(u * along + v * up);
  return digest;
}

/// The four walls and the floor of a room, seen from its middle, `high` metres.
inline ScanDigest drawn_room(const Vector3d& middle, double wide, double deep, double high = 2.5) {
  ScanDigest scan;
  const double x = 0.5 * wide;
  const double y = 0.5 * deep;
  scan.planes = {rectangle(middle + Vector3d(x, 0, 0), -Vector3d::UnitX(), deep, high),
                 rectangle(middle - Vector3d(x, 0, 0), Vector3d::UnitX(), deep, high),
                 rectangle(middle + Vector3d(0, y, 0), -Vector3d::UnitY(), wide, high),
                 rectangle(middle - Vector3d(0, y, 0), Vector3d::UnitY(), wide, high),
                 rectangle(middle - Vector3d(0, 0, 0.5 * high), Vector3d::UnitZ(), wide, deep)};
  scan.stations = {middle};
  scan.upright = true;
  return scan;
}

/// A turn about the vertical, radians, then a shift.
inline Rigid3 turn_and_shift(double turn, const Vector3d& shift) {
  return {rotation_exp(Vector3d(0, 0, turn)), shift};
}

}  // namespace limen
