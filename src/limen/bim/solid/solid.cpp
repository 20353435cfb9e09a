// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/bim/solid/solid.h"

namespace limen {

Box3 box_of(const PolygonMesh& mesh) {
  constexpr double kFarthestOfBox_m = 1e9;
  Box3 box;
  for (const std::uint32_t corner : mesh.corners) {
    if ((mesh.points[corner].array().abs() < kFarthestOfBox_m).all()) box.add(mesh.points[corner]);
  }
  return box;
}

Box3 box_of(const Solid& solid) {
  Box3 box = box_of(solid.mesh);
  for (const Solid& child : solid.children) {
    const Box3 of_child = box_of(child);
    if (of_child.empty()) continue;
    box.add(of_child.low);
    box.add(of_child.high);
    if (solid.operation == SolidOperation::subtract) break;
  }
  return box;
}

void move(Solid& solid, double scale, const Vector3d& shift) {
  for (Vector3d& point : solid.mesh.points) point = scale * point - shift;
  for (Solid& child : solid.children) move(child, scale, shift);
}

}  // namespace limen
