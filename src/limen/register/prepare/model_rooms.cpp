// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/prepare/model_rooms.h"

#include <cmath>

namespace limen {
namespace {

/// Whether an upward ray from `at` leaves the closed boundary an odd number of times.
bool inside(const BimSpace& room, const Vector3d& at) {
  // Not quite upright, so that it meets no upright face or edge along its length.
  const Vector3d ray = Vector3d(0.0123, 0.0071, 1.0).normalized();
  int crossed = 0;
  for (const BimFace& face : room.faces) {
    const double slope = face.plane.normal.dot(ray);
    if (std::abs(slope) < 1e-9) continue;
    const double range = -face.plane.signed_distance(at) / slope;
    if (range > 0 && contains(face.outline, face.frame.to_plane(at + range * ray))) ++crossed;
  }
  return crossed % 2 == 1;
}

}  // namespace

std::string room_at(const std::vector<BimSpace>& rooms, const Vector3d& at) {
  for (const BimSpace& room : rooms) {
    if (!inside(room, at)) continue;
    std::string name = room.name.empty() ? room.guid : room.name;
    if (!room.storey.empty()) name += ", " + room.storey;
    return name;
  }
  return {};
}

}  // namespace limen
