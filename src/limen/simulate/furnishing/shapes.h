// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/base/random.h"
#include "limen/simulate/buildings/mesh.h"

namespace limen {

/// Adds solids in the frame of a piece: x along its back, y away from it, z up.
class ShapeBuilder {
 public:
  ShapeBuilder(Mesh& mesh, const Vector3d& origin, const Vector2d& along, double reflectivity);

  void box(const Vector3d& bottom_middle, const Vector3d& size, double yaw_rad = 0.0);
  /// Upright; `top` times the radius at its upper end.
  void cylinder(const Vector3d& bottom_middle, double radius, double height, double top = 1.0);
  void ellipsoid(const Vector3d& middle, const Vector3d& radii);
  /// Loose triangles in an ellipsoid: leaves.
  void leaves(const Vector3d& middle, const Vector3d& radii, int count, RandomStream& random);
  /// A tilted board: a thin sheet that stands on `bottom_middle` and leans back by `lean_rad`.
  void leaning_board(const Vector3d& bottom_middle, double width, double height, double lean_rad);

 private:
  [[nodiscard]] Vector3d at(const Vector3d& p) const;
  [[nodiscard]] Surface round() const;

  Mesh& mesh_;
  Vector3d origin_;
  Vector3d x_;
  Vector3d y_;
  double yaw_;
  Surface like_;
};

}  // namespace limen
