// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/simulate/recipes.h"
#include "limen/simulate/scanner/ray_caster.h"

namespace limen {

/// A tripod's place: scanner centre in the scene's frame and the room it stands in.
struct Station {
  Vector3d position = Vector3d::Zero();
  std::size_t room = 0;
};

/// Free places for all stations of a recipe: on the floor, clear of walls and furniture, no two alike; where
/// the recipe asks, two of them in sight of one another through an open door.
std::vector<Station> place_stations(const Recipe& recipe, const RayCaster& caster, RandomStream& random);

}  // namespace limen
