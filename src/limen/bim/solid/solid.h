// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limen/bim/solid/polygon_mesh.h"
#include "limen/geometry/polygon.h"

namespace limen {

/// Which side of a plane is meant where a solid has a face in it.
enum class PlaneSide { before, behind };  ///< before: where the normal points to

/// The section of a closed, outwards oriented mesh with the plane of `frame` (normal u x v), in plane
/// coordinates. Where the mesh has corners within 0.1 mm of the plane, the section is taken 0.2 mm off it, on
/// the side asked for.
std::vector<Polygon> section(const PolygonMesh& mesh, const PlaneFrame& frame, PlaneSide side);

enum class SolidOperation : std::uint8_t {
  mesh,       ///< no operation: the closed mesh itself
  unite,      ///< all children together
  intersect,  ///< what all children share
  subtract    ///< the first child without all others
};

/// A solid as a model file builds it up: a mesh, or an operation of others. Metres.
struct Solid {
  SolidOperation operation = SolidOperation::mesh;
  PolygonMesh mesh;  ///< of a mesh
  std::vector<Solid> children;
};

/// Axis-aligned box in space; empty: low > high.
struct Box3 {
  Vector3d low = Vector3d::Constant(1e300);
  Vector3d high = Vector3d::Constant(-1e300);

  void add(const Vector3d& x) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  [[nodiscard]] bool empty() const { return low.x() > high.x(); }
  [[nodiscard]] bool touches(const Box3& other, double margin_m) const {
    return (low.array() <= other.high.array() + margin_m).all() &&
           (other.low.array() <= high.array() + margin_m).all();
  }
};

/// The box of the polygons' corners; corners that are not finite do not count.
Box3 box_of(const PolygonMesh& mesh);
Box3 box_of(const Solid& solid);

/// The same solid with each point x at scale * x - shift.
void move(Solid& solid, double scale, const Vector3d& shift);

}  // namespace limen
