// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
//
// What becomes of a drawing when it is built: every wall face, floor, ceiling and opening is a little off its
// place and leans. All faces stay planes; corners are where the planes meet, so that rooms stay closed.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "limen/simulate/buildings/floor_plan.h"
#include "limen/simulate/buildings/mesh.h"
#include "limen/simulate/buildings/opening_parts.h"

namespace limen {

/// By how much a plane is off: along its normal, and turned about its two axes.
struct PlaneDeviation {
  double offset_m = 0.0;
  double lean_rad = 0.0;  ///< out of plumb; of a level plane a slope
  double turn_rad = 0.0;  ///< in plan; of a level plane the slope across
};

/// The faces of one room, or of the outside, as built. Corner i lies where faces i - 1 and i meet.
struct BuiltSpace {
  std::vector<std::size_t> faces;  ///< counter-clockwise in plan, indices into FloorPlan::faces()
  Plane low;                       ///< of a room its floor; the normal points up
  Plane high;                      ///< of a room its ceiling, the normal down; of the outside the roof, up
  std::vector<Vector3d> low_corners;
  std::vector<Vector3d> high_corners;
};

/// The as-built shape of one building. The same plan and seed give the same shape.
class AsBuilt {
 public:
  AsBuilt(const FloorPlan& plan, const std::vector<WallFace>& faces,
          const std::vector<std::array<std::size_t, 2>>& back_to_back, std::uint64_t seed);

  [[nodiscard]] const Plane& wall(std::size_t face) const { return walls_[face]; }
  /// Lower left, lower right, upper right, upper left, seen from the visible side.
  [[nodiscard]] std::array<Vector3d, 4> corners(std::size_t face) const;
  [[nodiscard]] const BuiltSpace& room(std::size_t room) const { return spaces_[room]; }
  [[nodiscard]] const BuiltSpace& outside() const { return spaces_.back(); }

  /// Zero at the face's borders.
  [[nodiscard]] Bulge bulge(std::size_t face) const;

  /// Carries what is in a room along: its floor goes to the floor as built, its walls, on average, to the
  /// walls.
  [[nodiscard]] AffineMap in_room(std::size_t room) const;
  /// Carries what is fixed to a wall's face along.
  [[nodiscard]] AffineMap at_face(std::size_t face) const;
  /// An opening between two faces.
  [[nodiscard]] BuiltOpening opening(const OpeningShape& shape, std::size_t inner, std::size_t outer) const;

 private:
  void draw_walls(const std::vector<std::array<std::size_t, 2>>& back_to_back);
  void gather_spaces();
  void build(std::size_t space);
  /// False where the planes do not enclose the space that was drawn.
  bool place_corners(std::size_t space, const Ring& ring);
  void set_planes(std::size_t space, double share);
  [[nodiscard]] Plane level_plane(std::size_t space, bool high, double share) const;
  [[nodiscard]] double least_sill_clearance(const BuiltOpening& built, const OpeningShape& shape,
                                            std::size_t inner, std::size_t outer) const;

  const FloorPlan& plan_;
  const std::vector<WallFace>& faces_;
  std::uint64_t seed_;
  double quality_ = 1.0;
  std::vector<PlaneDeviation> wall_deviations_;
  std::vector<Plane> walls_;
  std::vector<BuiltSpace> spaces_;  ///< the rooms', then the outside
};

}  // namespace limen
