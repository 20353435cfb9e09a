// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "limen/base/random.h"
#include "limen/match/openings/opening_walls.h"

namespace limen {

/// A wall of a scan with the edges and corners of its openings, as 2022 and 2023, III, draw from them.
struct WallEdges {
  Vector3d normal = Vector3d::UnitX();  ///< unit, towards the scanner
  Vector3d right = Vector3d::UnitY();   ///< unit, as the scanner sees it; up is normal x right
  std::vector<Segment> vertical;        ///< upwards
  std::vector<Segment> horizontal;      ///< to the right
  std::vector<Vector3d> corners;
};

/// The walls of a scan that have openings, all four edges of each. `upright`: z is up.
std::vector<WallEdges> wall_edges(const Features& features, bool upright);

/// All edges of all walls.
std::vector<Segment> all_edges(const std::vector<WallEdges>& walls);

/// One item of a list that is not empty.
template <typename Item>
const Item& drawn(const std::vector<Item>& items, RandomStream& random) {
  return items[random.below(static_cast<std::uint32_t>(items.size()))];
}

}  // namespace limen
