// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "limen/base/random.h"
#include "limen/geometry/polygon.h"

namespace limen {

/// What a room is used for; decides its furniture.
enum class RoomUse { living, office, exhibition, corridor, stairs, empty };

/// A clear space: a horizontal outline (convex, counter-clockwise) between floor and ceiling, metres.
struct Room {
  Ring outline;
  double floor_m = 0.0;
  double ceiling_m = 2.7;
  int storey = 0;
  RoomUse use = RoomUse::living;
  int design = -1;        ///< rooms of one design are built alike, perhaps mirrored; -1: a room of its own
  int unit = -1;          ///< the flat, house or bay it belongs to; -1: none
  bool mirrored = false;  ///< the design's left is right here
  Vector2d design_origin = Vector2d::Zero();  ///< the plan's point where the design's own frame has (0, 0)
  Vector2d design_x = Vector2d::UnitX();      ///< the design's axes in the plan
  Vector2d design_y = Vector2d::UnitY();
};

/// An upright face of a room or of the outside: seen from the left of a -> b.
struct WallFace {
  Vector2d a = Vector2d::Zero();
  Vector2d b = Vector2d::Zero();
  double low_m = 0.0;
  double high_m = 0.0;
  int room = -1;  ///< -1: the outside

  [[nodiscard]] Vector2d normal() const;
  [[nodiscard]] double length() const { return (b - a).norm(); }
  /// u to the right as seen from its visible side, v up, origin at the lower left.
  [[nodiscard]] PlaneFrame frame() const;
};

/// Sizes of a building: a main wing along x and, where `turn_rad` is not 0, a second one at its end, turned
/// counter-clockwise. Each wing has a south row of rooms, optionally a corridor and a north row.
struct PlanOptions {
  std::vector<double> main_bays_m;    ///< widths of the main wing's bays, one window axis each
  std::vector<double> second_bays_m;  ///< of the oblique wing
  double turn_rad = 0.0;              ///< in (-0.8, 0.8); 0: no second wing
  double south_depth_m = 5.0;
  double corridor_m = 0.0;     ///< 0: none
  double north_depth_m = 0.0;  ///< 0: none
  double outer_wall_m = 0.4;
  double inner_wall_m = 0.15;
  int storeys = 1;
  double ground_floor_m = 0.3;   ///< above the street
  double storey_height_m = 3.2;  ///< floor to floor
  /// Of each storey, where they differ; storeys beyond the list have storey_height_m.
  std::vector<double> storey_heights_m = {};
  double slab_m = 0.35;
  int bays_per_room = 2;   ///< at most; the partition differs from storey to storey
  bool regular = false;    ///< every room has exactly bays_per_room bays
  bool stairwell = false;  ///< the last room of the main wing's north row holds the stairs
  RoomUse use = RoomUse::living;
};

/// A place for a window: a point on the envelope's line and how much wall there is to its sides.
struct WindowAxis {
  Vector2d at = Vector2d::Zero();
  double bay_m = 3.0;
  int bay = 0;
};

/// A door between two rooms, where it is not left to chance.
struct PlannedDoor {
  std::array<std::size_t, 2> rooms{};
  Vector2d at = Vector2d::Zero();  ///< the middle of its width, near the wall between the rooms
  double width_m = 0.0;            ///< 0: as the building's other doors
};

/// Rooms and envelope of one building.
struct FloorPlan {
  std::vector<Room> rooms;
  Ring envelope;  ///< counter-clockwise
  double base_m = 0.0;
  double roof_m = 3.0;
  std::vector<WindowAxis> axes;
  /// Empty: doors are chosen at random, so that all rooms can be reached.
  std::vector<PlannedDoor> doors = {};

  /// Faces of all rooms, then of the envelope.
  [[nodiscard]] std::vector<WallFace> faces() const;
};

FloorPlan make_floor_plan(const PlanOptions& options, RandomStream& random);

/// The part of a convex ring on the left of the line from `p` along `direction`.
Ring clipped(const Ring& ring, const Vector2d& p, const Vector2d& direction);

/// Places of another frame in the plan's: x = origin + rotation(angle) * y.
FloorPlan moved(const FloorPlan& plan, const Vector2d& origin, double angle_rad);

}  // namespace limen
