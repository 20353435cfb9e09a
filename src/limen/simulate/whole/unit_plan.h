// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
//
// Plans of buildings that repeat a unit: flats on a staircase, houses of a terrace, offices or hotel rooms on
// a corridor.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "limen/simulate/buildings/floor_plan.h"

namespace limen {

/// A rectangle between the middles of walls, in the unit's frame: x along the façade, y into the house.
struct UnitCell {
  double x0 = 0.0, y0 = 0.0, x1 = 0.0, y1 = 0.0;
  RoomUse use = RoomUse::living;
  bool mirrored = false;  ///< a copy, its left and right exchanged, of the cell `design`
  int design = -1;        ///< -1: its own index
  int flat = 0;           ///< in units of several dwellings: index of the dwelling
};

/// A door in the middle of which `at` lies. `rooms`: indices of cells; -1: the corridor behind the unit.
struct UnitDoor {
  std::array<int, 2> rooms{};
  Vector2d at = Vector2d::Zero();
};

/// A window's middle on the front (y = 0) or the back (y = depth) of the unit.
struct UnitWindow {
  Vector2d at = Vector2d::Zero();
  double bay_m = 3.0;  ///< wall that the window may take
};

/// One unit of a storey.
struct UnitTemplate {
  double width_m = 0.0;
  double depth_m = 0.0;
  std::vector<UnitCell> cells;
  std::vector<UnitDoor> doors;
  std::vector<UnitWindow> windows;
  int dwellings = 1;         ///< flats in it
  bool own_stairs = false;   ///< a house of its own: all storeys belong to one dwelling
  bool to_corridor = false;  ///< the back is the wall of a corridor
};

/// How units make a building.
struct RowOptions {
  int units = 1;  ///< side by side; on a corridor: on its south side (as many on the other)
  int storeys = 1;
  bool mirror_every_other = false;
  double corridor_m = 0.0;  ///< width, for units on a corridor
  int corridor_units = 6;   ///< between two doors across the corridor
  double stairs_m = 0.0;    ///< width of a staircase at the corridor's end; 0: none
  double outer_wall_m = 0.4;
  double party_wall_m = 0.25;
  double inner_wall_m = 0.12;
  double storey_height_m = 3.0;
  double slab_m = 0.3;
  double ground_floor_m = 0.5;
};

UnitTemplate office_unit(RoomUse use, RandomStream& random);
UnitTemplate hotel_unit(RandomStream& random);
UnitTemplate flats_unit(RandomStream& random);
UnitTemplate house_unit(RandomStream& random);

/// The plan; every room knows its design, its unit (flat, house or bay) and the design's frame.
FloorPlan make_row_plan(const UnitTemplate& unit, const RowOptions& options);

}  // namespace limen
