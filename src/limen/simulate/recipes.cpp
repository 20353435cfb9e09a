// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/simulate/recipes.h"

#include <array>
#include <utility>

#include "limen/base/angles.h"
#include "limen/base/error.h"
#include "limen/simulate/recipe_parts.h"
#include "limen/simulate/street.h"

namespace limen {
namespace {

Recipe room_recipe(const SceneOptions& options, RandomStream& random) {
  PlanOptions plan;
  plan.main_bays_m = bays(between(4, 6, random), 2.2, 3.4, random);
  plan.south_depth_m = random.uniform(3.6, 5.6);
  plan.corridor_m = random.uniform() < 0.5 ? random.uniform(1.3, 2.0) : 0.0;
  plan.north_depth_m = random.uniform(3.2, 4.6);
  plan.outer_wall_m = random.uniform(0.25, 0.5);
  plan.inner_wall_m = random.uniform(0.1, 0.24);
  plan.storey_height_m = random.uniform(2.85, 3.4);
  Recipe recipe = begun(options);
  FacadeOptions facade = random_facade(options, 0.15, random);
  facade.open_door_share = 0.9;
  add_building(recipe.world, make_floor_plan(plan, random), facade, random);
  furnish_all(recipe.world, 0, 0.9, random);
  add_ground(recipe.world);
  recipe.path = add_street(recipe.world, 0, {.opposite = facade}, random);
  add_garden(recipe.world, 0, 2, random);
  const auto rooms = rooms_where(recipe.world, random, [&](std::size_t room) {
    const Room& r = recipe.world.buildings[0].plan.rooms[room];
    return r.use != RoomUse::corridor && signed_area(r.outline) > 12.0 &&
           facades_of(recipe.world, room, View::any_window) > 0;
  });
  recipe.station_rooms.assign(2, rooms.empty() ? 0 : rooms[0]);
  return recipe;
}

/// An empty box whose only surfaces repeat under a turn: nothing distinguishes the poses.
Recipe symmetric_recipe(const SceneOptions& options, RandomStream& random) {
  const bool square = options.seed % 2 == 0;
  const double inner = random.uniform(4.0, 7.0);
  const double depth = square ? inner : inner * random.uniform(0.6, 0.85);
  PlanOptions plan;
  plan.outer_wall_m = 0.3;
  plan.main_bays_m = {inner + 2.0 * plan.outer_wall_m};
  plan.south_depth_m = depth;
  plan.storey_height_m = random.uniform(2.9, 3.3);
  plan.use = RoomUse::empty;
  plan.regular = true;
  FacadeOptions facade;
  facade.window_width_m = random.uniform(1.0, 1.6);
  facade.entrance = false;
  facade.ornament_share = 0.0;
  facade.curtain_share = 0.0;
  // Half of the boxes have the same window in every wall, with nothing outside.
  facade.blank_share = options.seed / 2 % 2 == 0 ? 1.0 : 0.0;
  facade.gable_share = 1.0 - facade.blank_share;
  Recipe recipe = begun(options);
  add_building(recipe.world, make_floor_plan(plan, random), facade, random);
  recipe.station_rooms = {0, 0};
  return recipe;
}

Recipe flat_recipe(const SceneOptions& options, RandomStream& random) {
  PlanOptions plan;
  plan.main_bays_m = bays(between(4, 6, random), 2.8, 4.2, random);
  plan.south_depth_m = random.uniform(3.4, 5.0);
  plan.corridor_m = random.uniform(1.2, 1.8);
  plan.north_depth_m = random.uniform(3.0, 4.5);
  plan.outer_wall_m = random.uniform(0.28, 0.45);
  plan.inner_wall_m = random.uniform(0.09, 0.2);
  plan.storey_height_m = random.uniform(2.8, 3.2);
  plan.bays_per_room = 1 + static_cast<int>(random.below(2));
  plan.ground_floor_m = random.uniform(0.3, 1.0);
  Recipe recipe = begun(options);
  FacadeOptions facade = random_facade(options, 0.2, random);
  facade.open_door_share = 1.0;
  facade.extra_door_share = 0.6;
  add_building(recipe.world, make_floor_plan(plan, random), facade, random);
  furnish_all(recipe.world, 0, 0.8, random);
  add_ground(recipe.world);
  recipe.path = add_street(recipe.world, 0, {.opposite = facade}, random);
  add_garden(recipe.world, 0, 2, random);
  recipe.through_door = true;
  recipe.station_rooms = {0, 0};
  return recipe;
}

Recipe museum_recipe(const SceneOptions& options, RandomStream& random) {
  PlanOptions plan;
  plan.main_bays_m = bays(between(5, 7, random), 2.7, 3.9, random);
  plan.second_bays_m = bays(between(3, 5, random), 2.9, 3.9, random);
  plan.turn_rad = radians(random.uniform(20.0, 35.0));
  plan.south_depth_m = random.uniform(4.6, 6.5);
  plan.corridor_m = random.uniform(1.8, 2.6);
  plan.north_depth_m = random.uniform(3.8, 5.2);
  plan.outer_wall_m = random.uniform(0.35, 0.6);
  plan.inner_wall_m = random.uniform(0.14, 0.3);
  plan.storeys = between(2, 3, random);
  plan.storey_height_m = random.uniform(3.5, 4.3);
  plan.slab_m = random.uniform(0.3, 0.45);
  plan.ground_floor_m = random.uniform(0.4, 1.1);
  plan.bays_per_room = between(2, 3, random);
  plan.stairwell = true;
  plan.use = RoomUse::exhibition;
  Recipe recipe = begun(options);
  FacadeOptions facade = random_facade(options, 0.05, random);
  facade.window_width_m = random.uniform(1.2, 1.8);
  facade.window_height_m = random.uniform(1.7, 2.2);
  facade.extra_door_share = 0.7;
  facade.door_width_m = random.uniform(1.1, 1.5);
  facade.door_height_m = random.uniform(2.1, 2.5);
  facade.gable_share = 1.0;
  add_building(recipe.world, make_floor_plan(plan, random), facade, random);
  furnish_all(recipe.world, 0, 0.7, random);
  add_ground(recipe.world);
  StreetOptions street{.edges = 3, .opposite = facade};
  street.path_m = random.uniform(7.0, 9.5);
  street.opposite_m = street.path_m + random.uniform(8.0, 11.0);
  recipe.path = add_street(recipe.world, 0, street, random);
  add_garden(recipe.world, 0, 4, random);
  choose_rooms_with_view(recipe, options, random);
  return finished(std::move(recipe), 800000, random);
}

/// Every bay and storey alike: only what lies outside the grid distinguishes shifts.
Recipe regular_recipe(const SceneOptions& options, RandomStream& random) {
  PlanOptions plan;
  const double bay_m = random.uniform(2.7, 3.3);
  plan.main_bays_m.assign(2 * static_cast<std::size_t>(between(4, 6, random)), bay_m);
  plan.south_depth_m = random.uniform(4.8, 6.0);
  plan.corridor_m = random.uniform(1.8, 2.4);
  plan.north_depth_m = plan.south_depth_m;
  plan.outer_wall_m = random.uniform(0.3, 0.5);
  plan.inner_wall_m = random.uniform(0.12, 0.2);
  plan.storeys = between(2, 4, random);
  plan.storey_height_m = random.uniform(3.1, 3.6);
  plan.bays_per_room = 2;
  plan.regular = true;
  plan.use = RoomUse::office;
  Recipe recipe = begun(options);
  FacadeOptions facade = random_facade(options, 0.1, random);
  facade.variation = 0.0;
  facade.blank_share = 0.0;
  facade.gable_share = 0.0;
  facade.entrance = false;
  add_building(recipe.world, make_floor_plan(plan, random), facade, random);
  furnish_all(recipe.world, 0, 0.6, random);
  add_ground(recipe.world);
  StreetOptions street{.edges = 1, .opposite = facade};
  street.path_m = random.uniform(7.0, 9.5);
  street.opposite_m = street.path_m + random.uniform(8.0, 11.0);
  recipe.path = add_street(recipe.world, 0, street, random);
  add_garden(recipe.world, 0, 2, random);
  const auto rooms = rooms_where(recipe.world, random, [&](std::size_t room) {
    const Room& r = recipe.world.buildings[0].plan.rooms[room];
    return r.use == RoomUse::office && r.storey < 2 && r.outline[0].y() < 1.0 &&
           facades_of(recipe.world, room, View::open_to_street) == 1;
  });
  recipe.station_rooms.assign(1, rooms.empty() ? 0 : rooms[0]);
  recipe.spare_rooms = rooms;
  return finished(std::move(recipe), 800000, random);
}

/// As many stations as were asked for: more ones stand in further rooms, or in the same where it is alone.
void set_station_count(Recipe& recipe, std::size_t count, RandomStream& random) {
  if (count == 0) return;
  const auto others = rooms_where(recipe.world, random, [&](std::size_t room) {
    return signed_area(recipe.world.buildings[0].plan.rooms[room].outline) > 8.0;
  });
  for (std::size_t i = 0; recipe.station_rooms.size() < count; ++i)
    recipe.station_rooms.push_back(others.empty() ? 0 : others[i % others.size()]);
  recipe.station_rooms.resize(count);
  recipe.through_door = recipe.through_door && count > 1;
}

struct NamedRecipe {
  const char* name;
  Recipe (*make)(const SceneOptions&, RandomStream&);
};

// The place in the list is the scene's random stream: new scenes go to the end.
constexpr std::array<NamedRecipe, 8> kRecipes = {{{"room", room_recipe},
                                                  {"symmetric_room", symmetric_recipe},
                                                  {"flat", flat_recipe},
                                                  {"museum", museum_recipe},
                                                  {"regular_facade", regular_recipe},
                                                  {"townhouse", townhouse_recipe},
                                                  {"villa", villa_recipe},
                                                  {"identical_bays", identical_recipe}}};

}  // namespace

std::vector<std::string> scene_names() {
  std::vector<std::string> names;
  names.reserve(kRecipes.size());
  for (const NamedRecipe& recipe : kRecipes) names.emplace_back(recipe.name);
  return names;
}

Recipe make_recipe(const SceneOptions& options) {
  std::string known;
  std::uint64_t trial = 1;
  for (const NamedRecipe& recipe : kRecipes) {
    RandomStream random(options.seed, trial++);
    if (options.name == recipe.name) {
      Recipe made = recipe.make(options, random);
      set_station_count(made, options.stations, random);
      if (options.points_outdoor == 0 && made.points_outdoor == 0) made.path.reset();
      if (options.outdoor == Outdoor::tripod) made.path.reset();
      made.national_grid = made.path.has_value();
      settle_furniture(made.world);
      return made;
    }
    known += known.empty() ? recipe.name : std::string(", ") + recipe.name;
  }
  throw Error("no scene is called '" + options.name + "'", "limen simulate", "choose one of: " + known);
}

}  // namespace limen
