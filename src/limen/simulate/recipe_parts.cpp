// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/simulate/recipe_parts.h"

#include "limen/base/angles.h"
#include "limen/simulate/buildings/building.h"

namespace limen {
namespace {

bool has_normal(const std::vector<Vector2d>& normals, const Vector3d& normal) {
  return std::any_of(normals.begin(), normals.end(),
                     [&](const Vector2d& n) { return n.x() * normal.x() + n.y() * normal.y() > 0.999; });
}

}  // namespace

Recipe begun(const SceneOptions& options) {
  Recipe recipe;
  if (options.as_built) recipe.world.as_built_seed = mix64(options.seed ^ 0xa5b01dULL);
  return recipe;
}

std::vector<double> bays(int count, double low, double high, RandomStream& random) {
  std::vector<double> widths;
  widths.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) widths.push_back(random.uniform(low, high));
  return widths;
}

int between(int low, int high, RandomStream& random) {
  return low + static_cast<int>(random.below(static_cast<std::uint32_t>(high - low + 1)));
}

FloorPlan equal_rooms(PlanOptions plan, double bay_m, int bays, RandomStream& random) {
  plan.main_bays_m.assign(static_cast<std::size_t>(bays), bay_m);
  plan.regular = true;
  plan.use = RoomUse::office;
  const double more = plan.outer_wall_m - 0.5 * plan.inner_wall_m;
  plan.main_bays_m.front() += more;
  plan.main_bays_m.back() += more;
  FloorPlan made = make_floor_plan(plan, random);
  std::vector<WindowAxis> axes;
  for (WindowAxis axis : made.axes)
    if (axis.bay < 200 && axis.at.y() < 0.5 * plan.south_depth_m) axes.push_back(axis);
  axes.front().at.x() += 0.5 * more;
  axes.back().at.x() -= 0.5 * more;
  for (WindowAxis& axis : axes) axis.bay_m = bay_m;
  made.axes = axes;
  return made;
}

FacadeOptions random_facade(const SceneOptions& options, double curtain_share, RandomStream& random) {
  FacadeOptions facade;
  facade.window_width_m = random.uniform(0.95, 1.7);
  facade.window_height_m = random.uniform(1.2, 1.7);
  facade.sill_m = random.uniform(0.55, 1.0);
  facade.variation = random.uniform(0.05, 0.2);
  facade.blank_share = random.uniform(0.0, 0.15);
  facade.frame_depth_m = random.uniform(0.06, 0.2);
  facade.bar_m = random.uniform(0.05, 0.08);
  facade.mullions = between(0, 2, random);
  facade.transoms = between(0, 1, random);
  facade.splay_m = random.uniform() < 0.25 ? random.uniform(0.03, 0.09) : 0.0;
  facade.door_width_m = random.uniform(0.82, 0.98);
  facade.door_height_m = random.uniform(1.98, 2.12);
  facade.curtain_share = options.curtain_share >= 0.0 ? options.curtain_share : curtain_share;
  return facade;
}

void furnish_all(World& world, std::size_t building, double fullness, RandomStream& random) {
  for (std::size_t room = 0; room < world.buildings[building].plan.rooms.size(); ++room)
    furnish(world, building, room, fullness * random.uniform(0.7, 1.2), random);
}

Recipe finished(Recipe recipe, std::size_t points_outdoor, RandomStream& random) {
  recipe.points_indoor = 300000;
  recipe.points_outdoor = points_outdoor;
  if (random.uniform() < 0.5) recipe.head_turns_rad = {radians(35.0), radians(-35.0)};
  recipe.wants_view = true;
  return recipe;
}

std::size_t facades_of(const World& world, std::size_t room, View view) {
  std::vector<Vector2d> normals;
  for (const TrueOpening& opening : world.openings) {
    if (!opening.exterior || opening.kind != "window" || opening.rooms[0] != static_cast<int>(room)) continue;
    const bool open = !opening.curtained && has_normal(world.buildings[0].street_normals, opening.normal);
    if (view == View::open_to_street && !open) continue;
    if (!has_normal(normals, opening.normal)) normals.emplace_back(opening.normal.x(), opening.normal.y());
  }
  return normals.size();
}

void choose_rooms_with_view(Recipe& recipe, const SceneOptions& options, RandomStream& random) {
  const World& world = recipe.world;
  const auto with = [&](std::size_t facades, bool exactly) {
    return rooms_where(world, random, [&](std::size_t room) {
      const std::size_t seen = facades_of(world, room, View::open_to_street);
      const Room& r = world.buildings[0].plan.rooms[room];
      return signed_area(r.outline) > 10.0 && r.storey < 2 && r.use != RoomUse::stairs &&
             (exactly ? seen == facades && facades_of(world, room, View::any_window) == facades
                      : seen >= facades);
    });
  };
  std::vector<std::size_t> rooms;
  if (options.facades > 0) rooms = with(options.facades, true);
  if (options.facades == 0) rooms = with(2, false);
  if (rooms.empty()) rooms = with(1, false);
  if (rooms.empty()) rooms = with(0, false);
  recipe.spare_rooms = rooms;
  rooms.resize(1, 0);
  const std::size_t count = std::max<std::size_t>(2, options.stations);
  for (const std::size_t room : with(1, false))
    if (rooms.size() < count && room != rooms[0]) rooms.push_back(room);
  while (rooms.size() < count) rooms.push_back(rooms[0]);
  recipe.station_rooms = rooms;
}

}  // namespace limen
