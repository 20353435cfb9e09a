// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
//
// Rooms in a row that repeat to the last chair, with nothing outside: shifts by a room cannot be
// distinguished.
#include "limen/simulate/buildings/building.h"
#include "limen/simulate/recipe_parts.h"
#include "limen/simulate/street.h"

namespace limen {
namespace {

constexpr int kBaysPerRoom = 2;

FloorPlan row_of_rooms(int rooms, RandomStream& random) {
  PlanOptions plan;
  const double bay = random.uniform(2.5, 3.2);
  plan.south_depth_m = random.uniform(4.6, 6.0);
  plan.outer_wall_m = random.uniform(0.3, 0.5);
  plan.inner_wall_m = random.uniform(0.12, 0.2);
  plan.storeys = 2;
  plan.storey_height_m = random.uniform(3.1, 3.5);
  plan.ground_floor_m = random.uniform(0.3, 0.8);
  plan.bays_per_room = kBaysPerRoom;
  return equal_rooms(plan, bay, kBaysPerRoom * rooms, random);
}

/// Furnishes one room and puts the same pieces at the same places of every other.
void furnish_alike(World& world, std::size_t model, RandomStream& random) {
  Building& building = world.buildings[0];
  const std::size_t taken = building.occupied[model].size();
  const std::size_t surfaces = world.mesh.surfaces().size();
  const std::size_t triangles = world.mesh.triangles().size();
  furnish(world, 0, model, 0.8, random);
  const std::size_t last_triangle = world.mesh.triangles().size();
  const Room& from = building.plan.rooms[model];
  for (std::size_t room = 0; room < building.plan.rooms.size(); ++room) {
    if (room == model) continue;
    const Room& to = building.plan.rooms[room];
    const Vector2d shift = to.outline[0] - from.outline[0];
    const MeshMark begin = world.mesh.mark();
    world.mesh.add_shifted(surfaces, {triangles, last_triangle},
                           {shift.x(), shift.y(), to.floor_m - from.floor_m});
    remember_furniture(world, 0, room, begin);
    for (std::size_t i = taken; i < building.occupied[model].size(); ++i) {
      Footprint copy = building.occupied[model][i];
      for (Vector2d& corner : copy.area) corner += shift;
      building.occupied[room].push_back(copy);
    }
  }
}

}  // namespace

Recipe identical_recipe(const SceneOptions& options, RandomStream& random) {
  const int rooms = between(5, 7, random);
  FacadeOptions facade = random_facade(options, 0.0, random);
  facade.variation = 0.0;
  facade.blank_share = 0.0;
  facade.entrance = false;
  facade.interior_doors = false;
  facade.ornament_share = 0.0;
  facade.curtain_share = 0.0;  // whatever was asked: curtains would distinguish rooms
  Recipe recipe = begun(options);
  add_building(recipe.world, row_of_rooms(rooms, random), facade, random);
  // Neither the first room nor the last: there is one more on either side.
  const auto model = static_cast<std::size_t>(between(1, rooms - 2, random));
  furnish_alike(recipe.world, model, random);
  add_ground(recipe.world);
  StreetOptions street;
  street.opposite_m = 0.0;
  street.bare = true;
  street.path_m = random.uniform(7.0, 9.5);
  recipe.path = add_street(recipe.world, 0, street, random);
  recipe.station_rooms = {model};
  recipe.spare_rooms = {model};
  recipe.points_indoor = 300000;
  recipe.points_outdoor = 800000;
  recipe.wants_view = true;
  return recipe;
}

}  // namespace limen
