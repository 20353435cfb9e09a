// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/refine/planes_by_wall.h"

#include <algorithm>
#include <cmath>

namespace limen {
namespace {

constexpr double kOneDirectionCosine = 0.99999;
constexpr double kMostWallM = 0.6;  // from one face to the other

}  // namespace

std::size_t PlanesByWall::wall_of(int plane) {
  const Plane& face = planes_[static_cast<std::size_t>(plane)].plane;
  const auto known = std::find_if(walls_.begin(), walls_.end(), [&](const Plane& wall) {
    const double cosine = wall.normal.dot(face.normal);
    const double offset = cosine < 0.0 ? -face.offset : face.offset;
    return std::abs(cosine) > kOneDirectionCosine && std::abs(wall.offset - offset) < kMostWallM;
  });
  if (known == walls_.end()) {
    walls_.push_back(face);
    return walls_.size() - 1;
  }
  return static_cast<std::size_t>(known - walls_.begin());
}

double PlanesByWall::sign_of(int plane) {
  const Vector3d& along = planes_[static_cast<std::size_t>(plane)].plane.normal;
  return normal(wall_of(plane)).dot(along) < 0.0 ? -1.0 : 1.0;
}

}  // namespace limen
