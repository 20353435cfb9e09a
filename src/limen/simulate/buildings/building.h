// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "limen/simulate/buildings/floor_plan.h"
#include "limen/simulate/buildings/opening_parts.h"

namespace limen {

/// How the windows of one storey differ from FacadeOptions, where storeys are not alike.
struct StoreyLook {
  double width = 1.0;   ///< times window_width_m
  double height = 1.0;  ///< times window_height_m
  double sill_m = 0.0;  ///< added
  HeadForm head = HeadForm::rectangular;
  double rise = 0.25;  ///< of a segmental arch, times the window's width
};

/// How a building's openings look.
struct FacadeOptions {
  double window_width_m = 1.2;
  double window_height_m = 1.5;
  double sill_m = 0.85;        ///< above the room's floor
  double variation = 0.0;      ///< share by which width, height, sill and place vary from bay to bay
  double blank_share = 0.0;    ///< bays without a window
  double curtain_share = 0.1;  ///< windows with a drawn curtain or blind
  double splay_m = 0.0;        ///< how much wider openings are inside
  double frame_depth_m = 0.1;
  double bar_m = 0.06;
  int mullions = 1;
  int transoms = 0;
  double gable_share = 0.7;        ///< gable rooms with a window
  double open_door_share = 0.75;   ///< doors that stand open
  double extra_door_share = 0.35;  ///< doors between neighbours beyond those needed to reach every room
  double ornament_share = 0.7;     ///< chance of a plinth, string courses, a cornice
  double door_width_m = 0.9;
  double door_height_m = 2.05;
  bool interior_doors = true;
  bool entrance = true;                  ///< a house door in the ground floor
  std::vector<StoreyLook> storeys = {};  ///< from the ground up; further storeys look like the last one
};

/// A floor area that furniture of some height must leave free, or that is taken.
struct Footprint {
  Ring area;            ///< convex, counter-clockwise
  double from_m = 0.0;  ///< only things higher than this above the floor are in the way
  bool piece = false;   ///< a piece of furniture that is on it, not a place kept free
};

/// The two faces of one wall: back to back, a room's and another room's or the outside's.
struct WallPair {
  std::size_t inner = 0;  ///< index into FloorPlan::faces()
  std::size_t outer = 0;
  double thickness_m = 0.0;
  double begin_m = 0.0;  ///< where the wall is common to both, along the outer face's u
  double end_m = 0.0;
};

/// All walls of a plan with at least `shortest_m` in common.
std::vector<WallPair> wall_pairs(const FloorPlan& plan, const std::vector<WallFace>& faces,
                                 double shortest_m);

struct World;

/// What of a mesh is in a room.
struct FurnitureRange {
  std::size_t room = 0;
  MeshMark begin;
  MeshMark end;
};

/// A room that is not quite as drawn.
struct BuiltRoom {
  Plane floor;
  AffineMap carry;  ///< of what is in it
};

/// A building that was put into a mesh, and what is needed to furnish and to scan it.
struct Building {
  FloorPlan plan;
  std::vector<std::vector<Footprint>> occupied;  ///< per room: door swings, window niches, furniture
  std::vector<Vector2d> street_normals;          ///< outward normals of the façades a street follows
  int room_offset = 0;                           ///< added to room numbers in TrueOpening::rooms
  std::vector<BuiltRoom> built = {};             ///< per room, where the building is not as drawn; else empty
  std::vector<FurnitureRange> furniture = {};

  /// Of the floor as built.
  [[nodiscard]] double floor_height(std::size_t room, const Vector2d& at) const;
};

/// Remembers what was added since `begin` as standing in a room.
void remember_furniture(World& world, std::size_t building, std::size_t room, const MeshMark& begin);

/// Everything that is built: triangles and the openings among them, in the scene's frame.
struct World {
  Mesh mesh;
  std::vector<TrueOpening> openings;
  std::vector<Building> buildings;
  /// Buildings that are added are off their drawing by millimetres to a centimetre, which this seed draws;
  /// none: they are as drawn.
  std::optional<std::uint64_t> as_built_seed = std::nullopt;
};

/// Within this distance faces share a true plane: those of a drawing are coplanar, those of a building are
/// not.
inline double merge_distance(const World& world) {
  return world.as_built_seed ? 1e-9 : 1e-3;
}

/// Puts all furniture where the rooms, as built, have it. To be called once, when the world is complete.
void settle_furniture(World& world);

/// Adds walls, slabs, windows, doors, roof and ornaments of a plan to the world. Returns its index.
std::size_t add_building(World& world, const FloorPlan& plan, const FacadeOptions& options,
                         RandomStream& random);

/// The horizontal rectangle about `centre` with its first side along the unit vector `along`.
Ring rectangle_ring(const Vector2d& centre, const Vector2d& along, const Vector2d& size);

/// Fills a room by its use: cupboards and beds along walls, tables with chairs, display cases, pillars,
/// lamps, pictures, radiators below the windows. Nothing overlaps, doors and windows stay free.
/// `fullness` in [0, 1]: 0 leaves the room empty.
void furnish(World& world, std::size_t building, std::size_t room, double fullness, RandomStream& random);

/// Whether a disc about `p` is inside the room and clear of everything recorded for it.
bool is_free(const Building& building, std::size_t room, const Vector2d& p, double radius_m);

}  // namespace limen
