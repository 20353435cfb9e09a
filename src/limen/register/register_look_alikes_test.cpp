// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
//
// Rooms built alike, to the last window: one room scanned twice is registered, two of them are not.
#include <array>

#include <gtest/gtest.h>

#include "limen/register/judge/score_pose.h"
#include "limen/register/judge/seen_clutter.h"
#include "limen/register/prepare/prepare_scan.h"
#include "limen/register/register.h"
#include "limen/simulate/buildings/building.h"
#include "limen/simulate/recipe_parts.h"
#include "limen/simulate/scanner/ray_caster.h"
#include "limen/simulate/scanner/station_scan.h"
#include "limen/simulate/stations.h"

namespace limen {
namespace {

enum class Furniture { own, alike, none, leaf };

constexpr std::size_t kPoints = 80000;

/// A row of rooms of one width with windows at the same places.
Recipe bare_rooms(RandomStream& random) {
  PlanOptions plan;
  const double bay = random.uniform(2.4, 3.0);
  plan.south_depth_m = 5.0;
  plan.bays_per_room = 2;
  const FloorPlan made = equal_rooms(plan, bay, 8, random);
  FacadeOptions facade;
  facade.curtain_share = 0.0;
  facade.interior_doors = false;
  facade.entrance = false;
  facade.ornament_share = 0.0;
  Recipe recipe;
  add_building(recipe.world, made, facade, random);
  return recipe;
}

/// From a place in room 1 to the same place in room 2.
Vector2d next_room(const World& world) {
  const FloorPlan& plan = world.buildings[0].plan;
  return plan.rooms[2].outline[0] - plan.rooms[1].outline[0];
}

/// Nothing but a leaf that is open, at the same angle in both rooms.
void add_leaves(World& world) {
  const FloorPlan& plan = world.buildings[0].plan;
  Vector2d middle = Vector2d::Zero();
  for (const Vector2d& corner : plan.rooms[1].outline)
    middle += corner / static_cast<double>(plan.rooms[1].outline.size());
  for (const Vector2d& shift : {Vector2d(0, 0), next_room(world)}) {
    const Vector2d at = middle + shift + Vector2d(0.8, 1.2);
    world.mesh.add_box({{at.x(), at.y(), plan.rooms[1].floor_m}, 0.3}, {0.9, 0.04, 2.0},
                       surface_of(Element::furniture));
  }
}

/// Rooms 1 and 2 with furniture of their own, or with the same pieces 3 cm off their places.
void furnish_both(World& world, Furniture furniture, RandomStream& random) {
  if (furniture == Furniture::none) return;
  if (furniture == Furniture::leaf) return add_leaves(world);
  const std::size_t surfaces = world.mesh.surfaces().size();
  const std::size_t triangles = world.mesh.triangles().size();
  furnish(world, 0, 1, 0.4, random);
  if (furniture == Furniture::own) return furnish(world, 0, 2, 0.4, random);
  Building& building = world.buildings[0];
  const Vector2d shift = next_room(world);
  world.mesh.add_shifted(surfaces, {triangles, world.mesh.triangles().size()},
                         {shift.x() + 0.03, shift.y() - 0.025, 0.0});
  for (Footprint copy : building.occupied[1]) {
    for (Vector2d& corner : copy.area) corner += shift;
    building.occupied[2].push_back(copy);
  }
}

/// Two stations in room 1 and one in room 2.
struct LookAlikeCase {
  std::array<Scan, 3> scans;
  std::array<Rigid3, 3> scene_from_scan;
};

LookAlikeCase look_alike_case(std::uint64_t seed, Furniture furniture) {
  RandomStream random(seed, 0);
  Recipe recipe = bare_rooms(random);
  furnish_both(recipe.world, furniture, random);
  recipe.station_rooms = {1, 1, 2};
  const RayCaster caster(recipe.world.mesh);
  const std::vector<Station> stations = place_stations(recipe, caster, random);
  LookAlikeCase made;
  for (std::size_t i = 0; i < 3; ++i) {
    const Rigid3 head{any_heading(random), stations.at(i).position};
    const Sweep echoes = sweep_of_points(
        kPoints, [&](std::size_t pulses) { return station_pattern(head, pulses); },
        [&](const ScanPattern& pattern) {
          return sweep(caster, recipe.world.openings, pattern, {}, 10 * seed + i);
        });
    made.scans[i] = station_scan("station", echoes, inverse(head));
    made.scans[i].level = true;
    made.scene_from_scan[i] = head;
  }
  return made;
}

TEST(RegisterLookAlikes, OneRoomScannedTwiceIsRegistered) {
  const LookAlikeCase rooms = look_alike_case(4, Furniture::own);
  const RegistrationResult result = register_scans(rooms.scans[1], rooms.scans[0]);
  // The building is exactly as drawn, so that its walls say nothing: things alone exclude a look-alike.
  EXPECT_TRUE(result.outcome == Outcome::registered || result.outcome == Outcome::probable) << result.reason;
  EXPECT_GT(result.best.probability.value_or(0.0), 0.99);
  const Rigid3 truth = inverse(rooms.scene_from_scan[0]) * rooms.scene_from_scan[1];
  EXPECT_LT((result.best.target_from_source.translation - truth.translation).norm(), 0.01);
  ASSERT_TRUE(result.others);
  EXPECT_LT(result.others->look_alike, 0.01);
}

TEST(RegisterLookAlikes, TwoRoomsBuiltAlikeAreNot) {
  const LookAlikeCase rooms = look_alike_case(2, Furniture::own);
  EXPECT_NE(register_scans(rooms.scans[2], rooms.scans[0]).outcome, Outcome::registered);
}

TEST(RegisterLookAlikes, NorAreTwoFurnishedAlike) {
  const LookAlikeCase rooms = look_alike_case(3, Furniture::alike);
  const RegistrationResult same = register_scans(rooms.scans[1], rooms.scans[0]);
  // Exactly as drawn, and furnished so that a look-alike is conceivable: placed, but not sure.
  EXPECT_GT(same.best.probability.value_or(0.0), 0.95) << same.reason;
  const RegistrationResult look_alikes = register_scans(rooms.scans[2], rooms.scans[0]);
  EXPECT_NE(look_alikes.outcome, Outcome::registered) << look_alikes.reason;
  ASSERT_TRUE(look_alikes.others);
  // Rare as such look-alike places are, it is far more probable than any risk that is taken.
  EXPECT_GT(look_alikes.others->look_alike, 20.0 * VerdictOptions{}.risk);
}

/// What things say of two scans of one room.
struct AskedRoom {
  PreparedScan source;
  PreparedScan target;
  Rigid3 upright;
  SeenClutter clutter;
};

AskedRoom asked_room(const LookAlikeCase& rooms) {
  AskedRoom asked;
  asked.source = prepare_scan(rooms.scans[1], prepare_options({}));
  asked.target = prepare_scan(rooms.scans[0], prepare_options({}));
  const Rigid3 truth =
      to_local(inverse(rooms.scene_from_scan[0]) * rooms.scene_from_scan[1],
               asked.source.extracted.features.local_origin, asked.target.extracted.features.local_origin);
  asked.upright = {
      asked.target.upright_from_scan * truth.rotation * asked.source.upright_from_scan.transpose(),
      asked.target.upright_from_scan * truth.translation};
  asked.clutter = seen_clutter(asked.source.view(), asked.target.view(), asked.upright);
  return asked;
}

TEST(RegisterLookAlikes, OneLeafIsOneThing) {
  for (const std::uint64_t seed : {6U, 7U}) {
    const SeenClutter leaf = asked_room(look_alike_case(seed, Furniture::leaf)).clutter;
    const SeenClutter furnished = asked_room(look_alike_case(seed, Furniture::own)).clutter;
    EXPECT_GT(leaf.pieces.count, 0.5) << seed;
    EXPECT_LT(leaf.pieces.count, 4.0) << seed;
    EXPECT_GT(furnished.pieces.count, 2.0 * leaf.pieces.count) << seed;
  }
}

TEST(RegisterLookAlikes, BareRoomsCannotBeStated) {
  const LookAlikeCase rooms = look_alike_case(5, Furniture::none);
  for (const std::size_t source : {1U, 2U}) {
    const RegistrationResult result = register_scans(rooms.scans[source], rooms.scans[0]);
    EXPECT_NE(result.outcome, Outcome::registered) << source;
  }
}

}  // namespace
}  // namespace limen
