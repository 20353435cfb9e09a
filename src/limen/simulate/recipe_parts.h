// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
//
// What the built-in scenes are put together from.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "limen/simulate/recipes.h"

namespace limen {

/// A recipe without a building, as drawn or as built.
Recipe begun(const SceneOptions& options);

/// `count` bay widths between two bounds.
std::vector<double> bays(int count, double low, double high, RandomStream& random);

/// A whole number in [low, high].
int between(int low, int high, RandomStream& random);

/// Rooms of one clear width in a row, of `bays` bays together, with windows in the street's façade only, at
/// the same places in every room. The first and the last bay are wider by what the outer wall takes more.
FloorPlan equal_rooms(PlanOptions plan, double bay_m, int bays, RandomStream& random);

/// The look of a house, different for every seed. `curtain_share`: where the options leave it to the scene.
FacadeOptions random_facade(const SceneOptions& options, double curtain_share, RandomStream& random);

/// Furnishes every room of a building.
void furnish_all(World& world, std::size_t building, double fullness, RandomStream& random);

enum class View { any_window, open_to_street };

/// How many façades a room of building 0 has such windows in.
std::size_t facades_of(const World& world, std::size_t room, View view);

/// Rooms of building 0 that satisfy `good`, in random order.
template <typename Good>
std::vector<std::size_t> rooms_where(const World& world, RandomStream& random, const Good& good) {
  std::vector<std::size_t> rooms;
  for (std::size_t room = 0; room < world.buildings[0].plan.rooms.size(); ++room)
    if (good(room)) rooms.push_back(room);
  for (std::size_t i = rooms.size(); i > 1; --i)
    std::swap(rooms[i - 1], rooms[random.below(static_cast<std::uint32_t>(i))]);
  return rooms;
}

/// Rooms for stations: the first one as `options.facades` asks, the others in rooms with open windows.
void choose_rooms_with_view(Recipe& recipe, const SceneOptions& options, RandomStream& random);

/// The recipe of a scene with a street: a room must see out of the window, and the scanner's head may be
/// turned.
Recipe finished(Recipe recipe, std::size_t points_outdoor, RandomStream& random);

/// Scenes of their own files.
Recipe townhouse_recipe(const SceneOptions& options, RandomStream& random);
Recipe villa_recipe(const SceneOptions& options, RandomStream& random);
Recipe identical_recipe(const SceneOptions& options, RandomStream& random);

}  // namespace limen
