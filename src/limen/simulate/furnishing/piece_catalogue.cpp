// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
//
// Which pieces there are, how large they are, and where they are found.
#include <algorithm>

#include "limen/simulate/furnishing/pieces.h"

namespace limen {
namespace {

struct SizeRange {
  PieceKind kind;
  Vector3d low;
  Vector3d high;
};

const SizeRange& range_of(PieceKind kind) {
  using enum PieceKind;
  static const std::vector<SizeRange> ranges = {{wardrobe, {0.9, 0.55, 1.9}, {2.4, 0.68, 2.35}},
                                                {cupboard, {0.6, 0.35, 1.1}, {1.4, 0.6, 2.0}},
                                                {open_shelf, {0.7, 0.25, 1.2}, {1.8, 0.4, 2.3}},
                                                {bed, {0.9, 1.95, 0.6}, {1.8, 2.15, 1.1}},
                                                {sofa, {1.4, 0.8, 0.75}, {2.4, 1.0, 0.95}},
                                                {armchair, {0.8, 0.75, 0.75}, {1.0, 0.95, 1.0}},
                                                {desk, {1.1, 0.6, 1.25}, {1.8, 0.8, 1.3}},
                                                {sideboard, {0.8, 0.35, 0.6}, {2.0, 0.5, 1.0}},
                                                {piano, {1.4, 0.66, 1.1}, {1.55, 0.66, 1.35}},
                                                {kitchen_row, {1.8, 0.6, 2.0}, {3.2, 0.65, 2.25}},
                                                {fridge, {0.6, 0.6, 1.4}, {0.7, 0.7, 2.0}},
                                                {dining_table, {1.9, 1.75, 0.95}, {3.0, 2.1, 0.95}},
                                                {round_table, {1.8, 1.8, 0.95}, {2.2, 2.2, 0.95}},
                                                {office_chair, {0.66, 0.66, 1.05}, {0.66, 0.66, 1.05}},
                                                {plant, {0.4, 0.4, 0.7}, {0.9, 0.9, 1.9}},
                                                {floor_lamp, {0.3, 0.3, 1.4}, {0.5, 0.5, 1.8}},
                                                {coat_stand, {0.5, 0.5, 1.6}, {0.6, 0.6, 1.9}},
                                                {box_pile, {0.4, 0.4, 0.3}, {0.8, 0.7, 1.3}},
                                                {display_case, {0.7, 0.5, 1.2}, {1.8, 0.9, 1.6}},
                                                {statue, {0.5, 0.5, 1.4}, {0.9, 0.9, 2.2}},
                                                {copier, {0.6, 0.6, 0.9}, {1.2, 0.75, 1.2}},
                                                {bicycle, {1.6, 0.5, 1.05}, {1.8, 0.5, 1.1}},
                                                {picture, {0.3, 0.02, 0.3}, {1.5, 0.05, 1.0}},
                                                {radiator, {0.6, 0.1, 0.5}, {1.4, 0.18, 0.62}},
                                                {ceiling_lamp, {0.5, 0.25, 0.2}, {1.3, 0.5, 0.7}},
                                                {small_object, {0.15, 0.15, 0.1}, {0.5, 0.45, 0.55}}};
  return *std::find_if(ranges.begin(), ranges.end(),
                       [&](const SizeRange& range) { return range.kind == kind; });
}

}  // namespace

Vector3d size_of(const Piece& piece) {
  const SizeRange& range = range_of(piece.kind);
  RandomStream random(piece.seed, 1);
  Vector3d size;
  for (int k = 0; k < 3; ++k) size[k] = random.uniform(range.low[k], range.high[k]);
  if (piece.kind == PieceKind::plant || piece.kind == PieceKind::statue ||
      piece.kind == PieceKind::round_table)
    size.y() = size.x();
  return size;
}

std::vector<PieceKind> wall_pieces(RoomUse use) {
  using enum PieceKind;
  switch (use) {
    case RoomUse::office:
      return {open_shelf, cupboard, desk, desk, sideboard, wardrobe, plant, copier, box_pile};
    case RoomUse::exhibition:
      return {display_case, cupboard, display_case, open_shelf, statue, sideboard, wardrobe};
    case RoomUse::living:
      return {wardrobe,  cupboard, open_shelf,  bed,    sofa,     desk,
              sideboard, piano,    kitchen_row, fridge, armchair, plant};
    case RoomUse::corridor:
      return {sideboard, cupboard, open_shelf, coat_stand, box_pile, plant, copier, bicycle};
    default:
      return {sideboard, cupboard, box_pile};
  }
}

std::vector<PieceKind> free_pieces(RoomUse use) {
  using enum PieceKind;
  switch (use) {
    case RoomUse::office:
      return {office_chair, office_chair, dining_table, round_table, plant, desk};
    case RoomUse::exhibition:
      return {display_case, statue, statue, plant};
    case RoomUse::living:
      return {dining_table, round_table, armchair, floor_lamp, plant};
    default:
      return {small_object};
  }
}

}  // namespace limen
