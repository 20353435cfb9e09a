// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/model/features.h"

namespace limen {

/// The planes of a model, by walls and slabs: the two faces of a wall were built together. Refers to the
/// planes.
class PlanesByWall {
 public:
  explicit PlanesByWall(const std::vector<PlanarPolygon>& planes) : planes_(planes) {}

  /// The wall that a plane of the model is a face of; walls are numbered as they are asked for.
  std::size_t wall_of(int plane);

  /// Of a wall's first face, in the model's frame.
  [[nodiscard]] const Vector3d& normal(std::size_t wall) const { return walls_[wall].normal; }

  /// -1 where a plane's normal is opposite to that of its wall, else 1.
  double sign_of(int plane);

 private:
  const std::vector<PlanarPolygon>& planes_;
  std::vector<Plane> walls_;
};

}  // namespace limen
