// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
//
// Dwelling houses on streets: a corner house in a terrace, and a villa that stands alone.
#include "limen/base/angles.h"
#include "limen/simulate/recipe_parts.h"
#include "limen/simulate/street.h"

namespace limen {
namespace {

/// Whether the first station's room has open windows in as many street façades as asked, and no others.
bool as_asked(const Recipe& recipe, const SceneOptions& options) {
  if (options.facades == 0) return true;
  const std::size_t room = recipe.station_rooms[0];
  return facades_of(recipe.world, room, View::open_to_street) == options.facades &&
         facades_of(recipe.world, room, View::any_window) == options.facades;
}

/// Builds house after house until one has a room as the options ask for; gives up after many.
template <typename Build>
Recipe with_view(const SceneOptions& options, RandomStream& random, const Build& build) {
  for (int attempt = 0;; ++attempt) {
    Recipe recipe = build();
    choose_rooms_with_view(recipe, options, random);
    if (as_asked(recipe, options) || attempt == 60) return recipe;
  }
}

template <typename Unwanted>
void drop_axes(FloorPlan& plan, const Unwanted& unwanted) {
  plan.axes.erase(std::remove_if(plan.axes.begin(), plan.axes.end(), unwanted), plan.axes.end());
}

bool on_gable(const WindowAxis& axis) {
  return axis.bay >= 200;
}

/// Another house of the terrace, wall to wall; its façade begins at `origin` and runs along `angle_rad`.
void add_neighbour(World& world, const Vector2d& origin, double angle_rad, FacadeOptions facade,
                   RandomStream& random) {
  PlanOptions plan;
  plan.main_bays_m = bays(between(3, 4, random), 2.2, 3.0, random);
  plan.south_depth_m = random.uniform(3.6, 4.6);
  plan.outer_wall_m = 0.4;
  plan.storeys = between(2, 4, random);
  plan.storey_height_m = random.uniform(2.7, 3.4);
  plan.ground_floor_m = random.uniform(0.15, 0.6);
  plan.use = RoomUse::empty;
  FloorPlan house = make_floor_plan(plan, random);
  double length = 0.0;
  for (const double bay : plan.main_bays_m) length += bay;
  drop_axes(house, on_gable);
  facade.interior_doors = false;
  facade.ornament_share = 0.0;
  facade.window_width_m = random.uniform(0.8, 1.3);
  facade.window_height_m = random.uniform(1.2, 1.8);
  facade.storeys.clear();
  // The neighbour to the west ends where this house begins.
  const Vector2d start = angle_rad == 0.0 ? Vector2d(origin - Vector2d(length, 0.0)) : origin;
  add_building(world, moved(house, start, angle_rad), facade, random);
}

/// Windows that differ from storey to storey; in some houses arched or round ones.
std::vector<StoreyLook> storey_looks(int storeys, RandomStream& random) {
  const bool curved = random.uniform() < 0.6;
  std::vector<StoreyLook> looks;
  for (int storey = 0; storey < storeys; ++storey) {
    StoreyLook look;
    look.width = random.uniform(0.8, 1.2);
    look.height = random.uniform(0.8, 1.1) - 0.06 * storey;
    look.sill_m = random.uniform(-0.2, 0.2);
    look.rise = random.uniform(0.12, 0.35);
    const double form = random.uniform();
    if (curved && form < 0.45) look.head = HeadForm::segmental;
    if (curved && form >= 0.45 && form < 0.8) look.head = HeadForm::semicircle;
    if (curved && storey > 1 && storey + 1 == storeys && form >= 0.8) look.head = HeadForm::round;
    looks.push_back(look);
  }
  return looks;
}

PlanOptions townhouse_plan(RandomStream& random) {
  PlanOptions plan;
  plan.main_bays_m = bays(between(3, 5, random), 2.0, 2.9, random);
  plan.south_depth_m = random.uniform(3.6, 5.2);
  plan.corridor_m = random.uniform() < 0.5 ? random.uniform(1.1, 1.5) : 0.0;
  plan.north_depth_m = random.uniform(3.2, 4.4);
  plan.outer_wall_m = random.uniform(0.3, 0.55);
  plan.inner_wall_m = random.uniform(0.09, 0.2);
  plan.storeys = between(2, 4, random);
  plan.storey_heights_m = {random.uniform(3.1, 4.0)};
  for (int storey = 1; storey < plan.storeys; ++storey)
    plan.storey_heights_m.push_back(random.uniform(2.55, 3.3));
  plan.slab_m = random.uniform(0.25, 0.35);
  plan.ground_floor_m = random.uniform(0.1, 0.7);
  plan.stairwell = true;
  return plan;
}

/// A corner house: streets to the south and the east, party walls to the west and the north.
Recipe build_townhouse(const SceneOptions& options, RandomStream& random) {
  const PlanOptions plan = townhouse_plan(random);
  FloorPlan house = make_floor_plan(plan, random);
  const Vector2d north_east = house.envelope[2];
  drop_axes(house, [&](const WindowAxis& axis) {
    const bool party = axis.bay == 200 || (!on_gable(axis) && axis.at.y() > 0.5 * north_east.y());
    return party || (on_gable(axis) && axis.bay_m == plan.corridor_m);
  });
  FacadeOptions facade = random_facade(options, 0.2, random);
  facade.window_width_m = random.uniform(0.8, 1.25);
  facade.window_height_m = random.uniform(1.4, 1.9);
  facade.gable_share = 1.0;
  facade.extra_door_share = 0.6;
  facade.storeys = storey_looks(plan.storeys, random);
  Recipe recipe = begun(options);
  add_building(recipe.world, house, facade, random);
  furnish_all(recipe.world, 0, 0.8, random);
  add_neighbour(recipe.world, {0.0, 0.0}, 0.0, facade, random);
  add_neighbour(recipe.world, north_east, radians(90.0), facade, random);
  add_ground(recipe.world);
  facade.storeys.clear();
  StreetOptions street{.edges = 2, .tree_spacing_m = 20.0, .opposite = facade};
  street.path_m = random.uniform(5.5, 8.0);
  street.opposite_m = street.path_m + random.uniform(6.5, 9.5);
  recipe.path = add_street(recipe.world, 0, street, random);
  return recipe;
}

PlanOptions villa_plan(RandomStream& random) {
  PlanOptions plan;
  plan.main_bays_m = bays(between(4, 5, random), 2.6, 4.0, random);
  plan.south_depth_m = random.uniform(3.8, 5.4);
  plan.corridor_m = random.uniform(1.4, 2.2);
  plan.north_depth_m = random.uniform(3.4, 4.8);
  plan.outer_wall_m = random.uniform(0.28, 0.45);
  plan.inner_wall_m = random.uniform(0.1, 0.2);
  plan.storeys = 2;
  plan.storey_heights_m = {random.uniform(2.8, 3.3), random.uniform(2.6, 3.0)};
  plan.slab_m = random.uniform(0.25, 0.35);
  plan.ground_floor_m = random.uniform(0.4, 1.1);
  plan.stairwell = true;
  return plan;
}

/// A house in its garden with a street on three sides; low sills on the ground floor.
Recipe build_villa(const SceneOptions& options, RandomStream& random) {
  const PlanOptions plan = villa_plan(random);
  FloorPlan house = make_floor_plan(plan, random);
  drop_axes(house, [&](const WindowAxis& axis) { return on_gable(axis) && axis.bay_m == plan.corridor_m; });
  FacadeOptions facade = random_facade(options, 0.15, random);
  facade.window_width_m = random.uniform(1.2, 2.1);
  facade.window_height_m = random.uniform(1.3, 1.6);
  facade.variation = random.uniform(0.1, 0.25);
  facade.gable_share = 0.9;
  facade.extra_door_share = 0.6;
  const double lower = facade.sill_m - random.uniform(0.15, 0.3);
  facade.storeys = {{.height = 1.0 + 0.8 * lower / facade.window_height_m, .sill_m = -lower},
                    {.width = random.uniform(0.75, 1.0)}};
  Recipe recipe = begun(options);
  add_building(recipe.world, house, facade, random);
  furnish_all(recipe.world, 0, 0.8, random);
  add_ground(recipe.world);
  facade.storeys.clear();
  StreetOptions street{.first_edge = 3, .edges = 3, .tree_spacing_m = 12.0, .opposite = facade};
  street.path_m = random.uniform(8.0, 11.0);
  street.opposite_m = street.path_m + random.uniform(9.0, 13.0);
  recipe.path = add_street(recipe.world, 0, street, random);
  add_garden(recipe.world, 0, 2, random);
  return recipe;
}

}  // namespace

Recipe townhouse_recipe(const SceneOptions& options, RandomStream& random) {
  return finished(with_view(options, random, [&] { return build_townhouse(options, random); }), 800000,
                  random);
}

Recipe villa_recipe(const SceneOptions& options, RandomStream& random) {
  // Three sides of a street are a long way.
  return finished(with_view(options, random, [&] { return build_villa(options, random); }), 1200000, random);
}

}  // namespace limen
