// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limen/simulate/furnishing/layout.h"

namespace limen {

/// How the rooms of a building are furnished.
struct FurnishingStyle {
  double least_hidden = 0.05;  ///< share of the walls' length that things stand before, drawn room by room
  double most_hidden = 0.6;
  double alike_share = 1.0 / 3.0;  ///< of the designs: their rooms have the same furniture, placed by hand
  double small_per_m2 = 0.12;
  double shift_m = 0.025;  ///< of pieces placed by hand, one standard deviation per axis
  double turn_rad = 0.02;
  double fixtures_m = 0.004;  ///< of fixtures in a building that is not as drawn, as of its openings
  /// Another day: some of the furniture moved or gone, what lies about is other. 0: the first day.
  std::uint64_t day = 0;
  double moved_share = 0.35;
  double removed_share = 0.1;
  double pushed_share = 0.4;    ///< of what stays: shifted by a centimetre; heavy things stay as they are
  double contents_share = 0.5;  ///< of the pieces: what is in and on them is new
};

/// Furnishes every room. Tells of each whether it has its design's furniture.
std::vector<bool> furnish_rooms(World& world, std::size_t building, const FurnishingStyle& style,
                                std::uint64_t seed);

}  // namespace limen
