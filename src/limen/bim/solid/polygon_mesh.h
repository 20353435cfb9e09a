// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "limen/geometry/rigid.h"

namespace limen {

/// A surface as a model file gives it: flat polygons over shared corners. A hole of a polygon is reached by a
/// bridge, an edge that is walked both ways.
struct PolygonMesh {
  std::vector<Vector3d> points;        ///< metres
  std::vector<std::uint32_t> corners;  ///< of all polygons, one after the other: indices into `points`
  std::vector<std::uint32_t> ends;     ///< one past the last corner of each polygon

  [[nodiscard]] std::size_t size() const { return ends.size(); }
  [[nodiscard]] std::uint32_t begin_of(std::size_t polygon) const {
    return polygon == 0 ? 0 : ends[polygon - 1];
  }
  void add(const std::vector<std::uint32_t>& polygon) {
    corners.insert(corners.end(), polygon.begin(), polygon.end());
    ends.push_back(static_cast<std::uint32_t>(corners.size()));
  }
};

/// Half the sum of cross products round a polygon (Newell): its unit normal times its area, m^2.
Vector3d area_vector(const PolygonMesh& mesh, std::size_t polygon);

/// The mesh with corners closer than about 0.01 mm made one, and without what has lost its area by that or
/// occurs twice (the same corners in the same sense). Corners that are not finite take their polygon
/// with them.
PolygonMesh welded(const PolygonMesh& mesh);

/// A welded mesh with one sense of winding: neighbours over an edge that two polygons share agree, and closed
/// parts have their normals outwards (a closed part inside another one is its cavity and may keep its own).
PolygonMesh oriented(PolygonMesh mesh);

/// The volume that the mesh encloses, m^3; of use only where it is closed.
double signed_volume(const PolygonMesh& mesh);
/// Whether each edge is walked as often one way as the other.
bool is_closed(const PolygonMesh& mesh);

}  // namespace limen
