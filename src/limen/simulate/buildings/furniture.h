// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/simulate/buildings/building.h"

namespace limen {

/// Fills a room by its use: cupboards and beds along walls, tables with chairs, display cases, pillars,
/// lamps, pictures, radiators below the windows. Nothing overlaps, doors and windows stay free.
/// `fullness` in [0, 1]: 0 leaves the room empty.
void furnish(World& world, std::size_t building, std::size_t room, double fullness, RandomStream& random);

/// Whether a disc about `p` is inside the room and clear of everything recorded for it.
bool is_free(const Building& building, std::size_t room, const Vector2d& p, double radius_m);

}  // namespace limen
