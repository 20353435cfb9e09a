// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/simulate/buildings/as_built.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include <gtest/gtest.h>

#include "limen/base/angles.h"
#include "limen/geometry/random_vectors.h"
#include "limen/simulate/recipes.h"
#include "limen/simulate/whole/whole_building.h"

namespace limen {
namespace {

World scene_world(const std::string& name, std::uint64_t seed, bool as_built) {
  SceneOptions options;
  options.name = name;
  options.seed = seed;
  options.as_built = as_built;
  return make_recipe(options).world;
}

/// A face of the drawing and what became of it.
struct FacePair {
  const Surface* drawn = nullptr;
  const Surface* built = nullptr;
  Vector3d middle = Vector3d::Zero();  ///< of the drawn face's corners
};

/// Both worlds have the same surfaces in the same order.
std::vector<FacePair> face_pairs(const World& drawn, const World& built) {
  std::vector<Vector3d> sums(drawn.mesh.surfaces().size(), Vector3d::Zero());
  std::vector<double> counts(sums.size(), 0.0);
  for (std::size_t i = 0; i < drawn.mesh.triangles().size(); ++i) {
    const auto surface = static_cast<std::size_t>(drawn.mesh.surface_of_triangle()[i]);
    for (const std::uint32_t corner : drawn.mesh.triangles()[i]) {
      sums[surface] += drawn.mesh.vertices()[corner];
      counts[surface] += 1.0;
    }
  }
  std::vector<FacePair> pairs;
  for (std::size_t i = 0; i < sums.size(); ++i)
    if (drawn.mesh.surfaces()[i].planar)
      pairs.push_back({&drawn.mesh.surfaces()[i], &built.mesh.surfaces()[i], sums[i] / counts[i]});
  return pairs;
}

struct Spread {
  double count = 0.0;
  double squares = 0.0;
  double largest = 0.0;

  void add(double value) {
    count += 1.0;
    squares += value * value;
    largest = std::max(largest, std::abs(value));
  }
  [[nodiscard]] double deviation() const { return std::sqrt(squares / count); }
};

struct Deviations {
  Spread offset_m;
  Spread lean_deg;
  double between = 0.0;  ///< faces that lean by 0.1 to 0.5 degrees
};

/// Of four kinds of buildings, three of each.
std::map<Element, Deviations> deviations() {
  std::map<Element, Deviations> all;
  for (const std::string name : {"room", "flat", "museum", "villa"}) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const World drawn = scene_world(name, seed, false);
      const World built = scene_world(name, seed, true);
      EXPECT_EQ(drawn.mesh.surfaces().size(), built.mesh.surfaces().size()) << name << seed;
      for (const FacePair& pair : face_pairs(drawn, built)) {
        const double cosine = std::min(1.0, pair.drawn->plane.normal.dot(pair.built->plane.normal));
        const double lean = degrees(std::acos(cosine));
        Deviations& of_kind = all[pair.drawn->element];
        of_kind.offset_m.add(pair.built->plane.signed_distance(pair.middle));
        of_kind.lean_deg.add(lean);
        of_kind.between += lean > 0.1 && lean < 0.5 ? 1.0 : 0.0;
      }
    }
  }
  return all;
}

TEST(AsBuilt, FacesAreOffByMillimetresToACentimetreAndLean) {
  const auto all = deviations();
  const Deviations& walls = all.at(Element::wall);
  EXPECT_GT(walls.offset_m.count, 500.0);
  EXPECT_GT(walls.offset_m.deviation(), 0.002);
  EXPECT_LT(walls.offset_m.deviation(), 0.008);
  EXPECT_LT(walls.offset_m.largest, 0.03);
  EXPECT_GT(walls.lean_deg.deviation(), 0.15);
  EXPECT_LT(walls.lean_deg.deviation(), 0.35);
  EXPECT_LT(walls.lean_deg.largest, 1.3);
  EXPECT_GT(walls.between / walls.lean_deg.count, 0.6);
  for (const Element element : {Element::floor, Element::ceiling, Element::reveal, Element::frame}) {
    const Deviations& faces = all.at(element);
    EXPECT_GT(faces.offset_m.deviation(), 0.001) << to_string(element);
    EXPECT_LT(faces.offset_m.deviation(), 0.012) << to_string(element);
    EXPECT_GT(faces.lean_deg.deviation(), 0.02) << to_string(element);
    EXPECT_LT(faces.lean_deg.deviation(), 0.6) << to_string(element);
  }
}

/// Two faces of one wall go the same way: a wall's thickness is off by less than its place.
TEST(AsBuilt, AWallKeepsItsThickness) {
  Spread thickness;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const World drawn = scene_world("flat", seed, false);
    const World built = scene_world("flat", seed, true);
    ASSERT_EQ(drawn.openings.size(), built.openings.size());
    for (std::size_t i = 0; i < drawn.openings.size(); ++i)
      if (!drawn.openings[i].exterior)
        thickness.add(built.openings[i].thickness_m - drawn.openings[i].thickness_m);
  }
  EXPECT_GT(thickness.count, 15.0);
  EXPECT_GT(thickness.deviation(), 0.001);
  EXPECT_LT(thickness.deviation(), 0.009);
}

TEST(AsBuilt, FollowsFromTheSeedAlone) {
  const World one = scene_world("museum", 4, true);
  EXPECT_EQ(one.mesh.vertices(), scene_world("museum", 4, true).mesh.vertices());
  EXPECT_NE(one.mesh.vertices(), scene_world("museum", 5, true).mesh.vertices());
  EXPECT_NE(one.mesh.vertices(), scene_world("museum", 4, false).mesh.vertices());
}

/// Rooms of one design have their sizes to the last bit as drawn, and none repeats another as built.
TEST(AsBuilt, NoRoomRepeatsAnotherToTheMillimetre) {
  const WholeBuilding building =
      make_whole_building({.name = "office_floor", .seed = 2, .stations = 24, .passes = 0, .as_built = true});
  const Building& house = building.world.buildings[0];
  std::vector<double> floors;
  for (std::size_t room = 0; room < house.built.size(); ++room) {
    if (house.plan.rooms[room].use != RoomUse::office) continue;
    const Vector2d& corner = house.plan.rooms[room].outline[0];
    floors.push_back(house.floor_height(room, corner) - house.plan.rooms[room].floor_m);
  }
  ASSERT_GT(floors.size(), 10U);
  std::sort(floors.begin(), floors.end());
  EXPECT_GT(floors.back() - floors.front(), 0.004);
  EXPECT_EQ(std::adjacent_find(floors.begin(), floors.end()), floors.end());
}

/// Where two walls, a floor or a ceiling and an opening meet there is no crack that a ray slips through.
TEST(AsBuilt, RaysFromInsideARoomEndInIt) {
  for (const std::string name : {"room", "flat", "museum", "townhouse", "identical_bays"}) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const World world = scene_world(name, seed, true);
      const RayCaster caster(world.mesh);
      const FloorPlan& plan = world.buildings[0].plan;
      RandomStream random(seed, 7);
      int escaped = 0;
      int rays = 0;
      for (const Room& room : plan.rooms) {
        if (room.use == RoomUse::stairs) continue;
        Vector2d middle = Vector2d::Zero();
        for (const Vector2d& p : room.outline) middle += p / static_cast<double>(room.outline.size());
        const Vector3d from(middle.x(), middle.y(), room.floor_m + 2.0);
        // Neither in a wardrobe nor in a lamp.
        if (caster.cast(from, Vector3d::UnitX()).inside || caster.cast(from, -Vector3d::UnitY()).inside)
          continue;
        for (int i = 0; i < 3000; ++i) {
          const Vector3d direction = vector_in_ball(random).normalized();
          const RayHit hit = caster.cast(from, direction);
          ++rays;
          const Element element = hit.found()
                                      ? world.mesh.surfaces()[static_cast<std::size_t>(hit.surface)].element
                                      : Element::ground;
          const Vector3d at = from + hit.range_m * direction;
          const bool outside = at.z() < room.floor_m - 0.05 || at.z() > room.ceiling_m + 0.05;
          escaped += !hit.found() || hit.inside || outside || element == Element::ground ? 1 : 0;
        }
      }
      EXPECT_GT(rays, 9000) << name << seed;
      EXPECT_EQ(escaped, 0) << name << seed << " of " << rays;
    }
  }
}

/// Legs end on the floor as built, whichever way it slopes.
TEST(AsBuilt, FurnitureStandsOnTheFloor) {
  const World drawn = scene_world("room", 3, false);
  const World built = scene_world("room", 3, true);
  const Building& house = built.buildings[0];
  const auto corners_of = [](const Mesh& mesh) {
    std::vector<std::vector<Vector3d>> corners(mesh.surfaces().size());
    for (std::size_t i = 0; i < mesh.triangles().size(); ++i)
      for (const std::uint32_t corner : mesh.triangles()[i])
        corners[static_cast<std::size_t>(mesh.surface_of_triangle()[i])].push_back(mesh.vertices()[corner]);
    return corners;
  };
  const auto before = corners_of(drawn.mesh);
  const auto after = corners_of(built.mesh);
  std::size_t standing = 0;
  double farthest = 0.0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const Surface& face = drawn.mesh.surfaces()[i];
    if (face.element != Element::furniture || face.plane.normal.z() > -0.99) continue;
    const Vector3d& x = before[i][0];
    const Vector3d& y = after[i][0];
    for (std::size_t room = 0; room < house.plan.rooms.size(); ++room) {
      if (!contains(house.plan.rooms[room].outline, x.head<2>())) continue;
      if (std::abs(x.z() - house.plan.rooms[room].floor_m) > 1e-9) continue;
      ++standing;
      farthest = std::max(farthest, std::abs(y.z() - house.floor_height(room, y.head<2>())));
    }
  }
  EXPECT_GT(standing, 20U);
  EXPECT_LT(farthest, 1e-9);
}

/// The clear opening in truth is the hole that was built: its corners lie on the wall's faces.
TEST(AsBuilt, OpeningsLieInBothFacesOfTheirWall) {
  for (const std::string name : {"museum", "townhouse", "flat"}) {
    const World world = scene_world(name, 3, true);
    const auto on_a_wall = [&](const Vector3d& x) {
      return std::any_of(world.mesh.surfaces().begin(), world.mesh.surfaces().end(), [&](const Surface& s) {
        return s.element == Element::wall && std::abs(s.plane.signed_distance(x)) < 1e-9;
      });
    };
    for (const TrueOpening& opening : world.openings) {
      for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_TRUE(on_a_wall(opening.outer[i])) << name;
        EXPECT_TRUE(on_a_wall(opening.inner[i])) << name;
      }
      const double width = (opening.outer[1] - opening.outer[0]).norm();
      EXPECT_GT(width, 0.4);
    }
  }
}

TEST(Mesh, APanelWithFourCornersLosesTheAreaOfItsHoles) {
  Mesh mesh;
  const std::array<Vector3d, 4> corners = {Vector3d(0.0, 0.0, 0.01), Vector3d(6.0, 0.0, -0.01),
                                           Vector3d(6.02, 0.0, 3.0), Vector3d(-0.01, 0.0, 3.02)};
  const Plane plane{-Vector3d::UnitY(), 0.0};
  std::vector<Vector3d> round;
  for (int i = 0; i < 24; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / 24;
    round.emplace_back(1.5 + 0.5 * std::cos(angle), 0.0, 1.5 + 0.5 * std::sin(angle));
  }
  const std::vector<Vector3d> door = {
      {4.0, 0.0, 0.006}, {4.9, 0.0, 0.004}, {4.903, 0.0, 2.1}, {4.01, 0.0, 2.099}};
  mesh.add_quad_panel(corners, plane, {round, door}, surface_of(Element::wall));
  const auto area_of_ring = [](const auto& ring) {
    double sum = 0.0;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Vector3d& p = ring[i];
      const Vector3d& q = ring[(i + 1) % ring.size()];
      sum += 0.5 * (p.x() * q.z() - q.x() * p.z());
    }
    return std::abs(sum);
  };
  EXPECT_NEAR(mesh.surfaces()[0].area_m2, area_of_ring(corners) - area_of_ring(round) - area_of_ring(door),
              1e-9);
  for (const auto& triangle : mesh.triangles()) {
    const Vector3d& a = mesh.vertices()[triangle[0]];
    const Vector3d turn = (mesh.vertices()[triangle[1]] - a).cross(mesh.vertices()[triangle[2]] - a);
    EXPECT_GE(plane.normal.dot(turn), -1e-12) << "no triangle looks the other way";
  }
}

}  // namespace
}  // namespace limen
