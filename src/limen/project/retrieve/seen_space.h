// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "limen/geometry/cell_numbers.h"
#include "limen/project/retrieve/placed_plane.h"

namespace limen {

/// A point of a surface and the area that it represents. Metres, m^2.
struct SurfacePoint {
  Vector3d x = Vector3d::Zero();
  Vector3d normal = Vector3d::UnitZ();
  double area_m2 = 0.0;
  bool oriented = false;
};

/// Nine points of a plane, its area shared among them; it counts for no more than 5 m^2.
void add_surface_points(const PlacedPlane& plane, std::vector<SurfacePoint>& points);

/// What planes and the lines of sight to them tell about space: which cells hold surface, and through which a
/// scanner looked. Cells are 0.25 m wide.
class SeenSpace {
 public:
  void add(const PlacedPlane& plane);

  enum class Finding { unknown, surface, looked_through };
  /// Surface: the point lies within 0.12 m in a plane that faces the same way. Looked through: a line of
  /// sight passes, and no plane of any direction is within 0.12 m.
  [[nodiscard]] Finding at(const SurfacePoint& point) const;
  /// How far the nearest surface that faces the same way is along the point's normal; nothing: farther than
  /// 0.4 m. Metres.
  [[nodiscard]] std::optional<double> way_to_surface(const SurfacePoint& point) const;

 private:
  struct Surface {
    Vector3d normal;
    double offset_m = 0.0;
    bool oriented = false;
  };
  struct Cell {
    std::vector<Surface> surfaces;
    bool clear = false;
  };
  Cell& cell_at(const Vector3d& x);
  [[nodiscard]] const Cell* find(const Vector3d& x) const;
  void cover(const Surface& surface, const Vector3d& x);

  CellNumbers numbers_;
  std::vector<Cell> cells_;
};

}  // namespace limen
