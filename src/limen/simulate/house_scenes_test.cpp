// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "limen/simulate/recipes.h"
#include "limen/simulate/stations.h"

namespace limen {
namespace {

SceneOptions scene(const std::string& name, std::uint64_t seed) {
  SceneOptions options;
  options.name = name;
  options.seed = seed;
  return options;
}

/// What a ray meets behind panes, or nothing.
RayHit first_hit(const RayCaster& caster, const Vector3d& origin, const Vector3d& direction) {
  double from = 0.0;
  for (;;) {
    const RayHit hit = caster.cast(origin, direction, from);
    if (!hit.found()) return hit;
    const Surface& surface = caster.mesh().surfaces()[static_cast<std::size_t>(hit.surface)];
    if (surface.element != Element::glass) return hit;
    from = hit.range_m + 1e-3;
  }
}

TEST(HouseScenes, IdenticalBaysLookTheSameFromEveryRoom) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Recipe recipe = make_recipe(scene("identical_bays", seed));
    const RayCaster caster(recipe.world.mesh);
    const auto& rooms = recipe.world.buildings[0].plan.rooms;
    const Room& home = rooms[recipe.station_rooms[0]];
    RandomStream random(seed, 77);
    const Station station = place_stations(recipe, caster, random)[0];
    ASSERT_EQ(station.room, recipe.station_rooms[0]);
    const ScanPattern pattern = station_pattern({Matrix3d::Identity(), station.position}, 2000);
    std::size_t others = 0;
    std::size_t different = 0;
    std::size_t outside = 0;
    for (const Room& room : rooms) {
      if (&room == &home || room.storey != home.storey) continue;
      ++others;
      const Vector2d way = room.outline[0] - home.outline[0];
      const Vector3d moved = station.position + Vector3d(way.x(), way.y(), 0.0);
      for (std::size_t line = 0; line < pattern.lines; ++line) {
        for (std::size_t i = 0; i < pattern.pulses_per_line; ++i) {
          const Vector3d direction = pattern.pulse(line, i).direction;
          const RayHit here = first_hit(caster, station.position, direction);
          const RayHit there = first_hit(caster, moved, direction);
          outside += !here.found() || here.range_m > 9.0 ? 1U : 0U;
          // A ray along an edge may fall to either side of it.
          if (here.found() != there.found() ||
              (here.found() && std::abs(here.range_m - there.range_m) > 1e-9))
            ++different;
        }
      }
    }
    EXPECT_GE(others, 4U);
    EXPECT_LE(different, 2U) << "seed " << seed;
    EXPECT_GT(outside, 20U) << "the windows are looked through";
  }
}

TEST(HouseScenes, HousesGiveTheFirstStationAsManyFacadesAsAsked) {
  for (const char* name : {"townhouse", "villa"}) {
    for (const std::size_t facades : {1U, 2U}) {
      for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        SceneOptions options = scene(name, seed);
        options.facades = facades;
        options.curtain_share = facades == 1 ? 0.6 : 0.1;
        const Recipe recipe = make_recipe(options);
        const World& world = recipe.world;
        std::vector<Vector3d> open;
        for (const TrueOpening& opening : world.openings) {
          if (!opening.exterior || opening.rooms[0] != static_cast<int>(recipe.station_rooms[0])) continue;
          if (opening.curtained) continue;
          const auto& streets = world.buildings[0].street_normals;
          EXPECT_TRUE(std::any_of(streets.begin(), streets.end(), [&](const Vector2d& n) {
            return n.dot(opening.normal.head<2>()) > 0.999;
          })) << "no open window looks elsewhere";
          if (std::none_of(open.begin(), open.end(),
                           [&](const Vector3d& n) { return n.dot(opening.normal) > 0.999; }))
            open.push_back(opening.normal);
        }
        EXPECT_EQ(open.size(), facades) << name << " seed " << seed;
      }
    }
  }
}

TEST(HouseScenes, TownhousesHaveCurvedWindowsInAShareOfSeeds) {
  int houses = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const Recipe recipe = make_recipe(scene("townhouse", seed));
    const auto& openings = recipe.world.openings;
    houses += std::any_of(openings.begin(), openings.end(),
                          [](const TrueOpening& opening) { return opening.head != "rectangular"; })
                  ? 1
                  : 0;
  }
  EXPECT_GT(houses, 10);
  EXPECT_LT(houses, 36);
}

}  // namespace
}  // namespace limen
