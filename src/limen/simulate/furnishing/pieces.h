// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limen/base/random.h"
#include "limen/simulate/buildings/floor_plan.h"
#include "limen/simulate/buildings/mesh.h"

namespace limen {

/// What stands, lies or hangs in rooms. Boxes are only some of them.
enum class PieceKind : std::uint8_t {
  wardrobe,
  cupboard,
  open_shelf,  ///< boards with books, boxes and bottles
  bed,
  sofa,  ///< rounded cushions
  armchair,
  desk,  ///< legs, a pedestal, a screen
  sideboard,
  piano,
  kitchen_row,
  fridge,
  dining_table,  ///< legs and chairs
  round_table,   ///< one foot, chairs around
  office_chair,  ///< star, column, seat
  plant,         ///< a pot and leaves
  floor_lamp,
  coat_stand,
  box_pile,
  display_case,
  statue,  ///< a figure of round parts on a plinth
  copier,
  bicycle,
  picture,       ///< on a wall
  radiator,      ///< ribs below a window
  ceiling_lamp,  ///< hangs
  small_object   ///< a bag, a bin, a ball, a bottle, a book
};

/// A piece: its kind, what fixes its sizes, and what fixes the things on and in it.
struct Piece {
  PieceKind kind = PieceKind::cupboard;
  std::uint64_t seed = 0;
  std::uint64_t contents_seed = 0;
};

/// Width along its back, depth, height, metres. The same seed gives the same sizes.
Vector3d size_of(const Piece& piece);

/// Where a piece is: the middle of its back edge on the floor, x along the back, y away from it.
struct PiecePlace {
  Vector3d back = Vector3d::Zero();
  Vector2d along = Vector2d::UnitX();
};

void add_piece(Mesh& mesh, const Piece& piece, const PiecePlace& place);

/// The kinds that stand along walls, stand free, and lie about, by the room's use.
std::vector<PieceKind> wall_pieces(RoomUse use);
std::vector<PieceKind> free_pieces(RoomUse use);

}  // namespace limen
