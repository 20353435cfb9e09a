// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "limen/simulate/recipes.h"
#include "limen/simulate/scanner/ray_caster.h"

namespace limen {

/// Instead of a room: outside the building.
constexpr std::size_t kStreet = static_cast<std::size_t>(-1);

/// A tripod's place: scanner centre in the scene's frame and the room it is in, or kStreet.
struct Station {
  Vector3d position = Vector3d::Zero();
  std::size_t room = 0;
};

/// Free places for all stations of a recipe: on the floor, clear of walls and furniture, no two alike; where
/// the recipe asks, two of them in sight of one another through an open door.
std::vector<Station> place_stations(const Recipe& recipe, const RayCaster& caster, RandomStream& random);

/// A tripod in the street from where much of the windows of a station's room is seen. Throws Error where
/// there is none.
Station place_in_street(const Recipe& recipe, const RayCaster& caster, const Station& inside,
                        RandomStream& random);

/// A tripod on the ground at a place in plan, with nothing within half a metre, or nothing.
std::optional<Vector3d> tripod_on_ground(const RayCaster& caster, const Vector2d& at, double height_m);

}  // namespace limen
