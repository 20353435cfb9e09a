// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limen/simulate/buildings/building.h"
#include "limen/simulate/furnishing/pieces.h"

namespace limen {

/// A piece of furniture in the frame of its room's design (Room::design_origin, _x, _y).
struct PlacedPiece {
  Piece piece;
  Vector2d back = Vector2d::Zero();    ///< middle of its back edge
  Vector2d along = Vector2d::UnitX();  ///< unit vector of the back edge; the piece is to the left of it
  double height_m = 0.0;               ///< of its foot above the floor
  bool fixture = false;                ///< built in (radiator, lamp): the same in every room of the design
};

using Layout = std::vector<PlacedPiece>;

/// How a room is furnished.
struct LayoutOptions {
  double hide_share = 0.35;   ///< of the walls' length that things stand before, about
  double free_per_m2 = 0.08;  ///< pieces that stand away from walls
  double pictures_per_m2 = 0.1;
  double small_per_m2 = 0.1;  ///< bags, bins, bottles on the floor
};

/// Radiators below windows and lamps at the ceiling.
Layout make_fixtures(const World& world, std::size_t building, std::size_t room, std::uint64_t seed);

/// Furniture for a room of a building that leaves doors, windows and what already is there free.
Layout make_layout(const World& world, std::size_t building, std::size_t room, const LayoutOptions& options,
                   std::uint64_t seed);

/// How a layout is carried out by people.
struct PlacingOptions {
  double shift_m = 0.0;   ///< one standard deviation, per axis; of chairs and small things three times that
  double turn_rad = 0.0;  ///< one standard deviation
  double moved_share = 0.0;    ///< of the pieces: they stand elsewhere in the room
  double removed_share = 0.0;  ///< of the pieces
  /// Of those that stay, but for chairs and small things: shifted and turned a bit.
  double pushed_share = 1.0;
  double contents_share = 1.0;  ///< of the pieces: what is in and on them is new
};

/// The layout as it comes out in one room: pieces a little off their places, some moved or gone.
Layout as_placed(const Layout& layout, const World& world, std::size_t building, std::size_t room,
                 const PlacingOptions& options, std::uint64_t seed);

/// Fixtures as they were put up: off their places by so much, one standard deviation, and not into the wall,
/// the floor or the ceiling.
Layout as_put_up(Layout fixtures, double shift_m, std::uint64_t seed);

/// Builds a layout in a room: its own or another of the same design, mirrored if need be. Pieces for which
/// there is no place are left out.
void add_layout(World& world, std::size_t building, std::size_t room, const Layout& layout);

}  // namespace limen
