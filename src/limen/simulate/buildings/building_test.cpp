// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/simulate/buildings/building.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "limen/simulate/recipes.h"

namespace limen {
namespace {

PlanOptions two_wings(double turn) {
  PlanOptions options;
  options.main_bays_m = {3.0, 3.2, 2.9, 3.4, 3.1};
  options.second_bays_m = {3.3, 3.0, 3.5};
  options.turn_rad = turn;
  options.corridor_m = 2.0;
  options.north_depth_m = 4.5;
  options.storeys = 2;
  options.stairwell = true;
  return options;
}

TEST(FloorPlan, RoomsLieInTheEnvelopeAndApart) {
  for (const double turn : {0.0, 0.4, 0.6, -0.5}) {
    RandomStream random(4);
    const FloorPlan plan = make_floor_plan(two_wings(turn), random);
    EXPECT_GT(signed_area(plan.envelope), 100.0);
    double rooms = 0.0;
    for (const Room& room : plan.rooms) {
      EXPECT_GT(signed_area(room.outline), 1.0);
      rooms += signed_area(room.outline);
      for (const Vector2d& corner : room.outline) EXPECT_TRUE(contains(plan.envelope, corner));
      Vector2d middle = Vector2d::Zero();
      for (const Vector2d& corner : room.outline) middle += corner / static_cast<double>(room.outline.size());
      for (const Room& other : plan.rooms)
        EXPECT_EQ(contains(other.outline, middle) && other.storey == room.storey, &other == &room);
    }
    EXPECT_LT(rooms, 2.0 * signed_area(plan.envelope));
    EXPECT_GT(rooms, 1.4 * signed_area(plan.envelope));
  }
}

TEST(FloorPlan, AnObliqueWingTurnsByTheAngleAsked) {
  RandomStream random(4);
  const FloorPlan plan = make_floor_plan(two_wings(0.5), random);
  ASSERT_EQ(plan.envelope.size(), 6U);
  const Vector2d first = (plan.envelope[1] - plan.envelope[0]).normalized();
  const Vector2d second = (plan.envelope[2] - plan.envelope[1]).normalized();
  EXPECT_NEAR(std::acos(first.dot(second)), 0.5, 1e-12);
  const auto pairs = wall_pairs(plan, plan.faces(), 0.8);
  EXPECT_TRUE(std::any_of(pairs.begin(), pairs.end(), [&](const WallPair& pair) {
    const auto faces = plan.faces();
    return faces[pair.outer].room >= 0 && std::abs(pair.thickness_m - 0.15) < 1e-9;
  }));
}

bool on_some_wall(const Mesh& mesh, const Vector3d& x, const Vector3d& normal) {
  return std::any_of(mesh.surfaces().begin(), mesh.surfaces().end(), [&](const Surface& surface) {
    return surface.element == Element::wall && surface.plane.normal.dot(normal) > 1.0 - 1e-9 &&
           std::abs(surface.plane.signed_distance(x)) < 1e-9;
  });
}

TEST(Building, OpeningsLieInBothFacesOfTheirWall) {
  for (const std::string& name : scene_names()) {
    SceneOptions options;
    options.name = name;
    options.seed = 3;
    const World world = make_recipe(options).world;
    for (const TrueOpening& opening : world.openings) {
      for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_NEAR(opening.normal.dot(opening.outer[i] - opening.inner[i]), opening.thickness_m, 1e-9);
        EXPECT_TRUE(on_some_wall(world.mesh, opening.outer[i], opening.normal)) << name;
        EXPECT_TRUE(on_some_wall(world.mesh, opening.inner[i], -opening.normal)) << name;
      }
      const Vector3d u = opening.outer[1] - opening.outer[0];
      const Vector3d v = opening.outer[3] - opening.outer[0];
      EXPECT_NEAR(u.z(), 0.0, 1e-12);
      EXPECT_GT(v.z(), 0.3);
      EXPECT_GT(u.cross(v).dot(opening.normal), 0.0) << "corners in order, seen from outside";
    }
  }
}

/// A ray through the middle of each open doorway and of each pane meets no wall there.
TEST(Building, HolesGoThroughTheWall) {
  SceneOptions options;
  options.name = "museum";
  const Recipe recipe = make_recipe(options);
  const RayCaster caster(recipe.world.mesh);
  int tried = 0;
  for (const TrueOpening& opening : recipe.world.openings) {
    if (opening.curtained) continue;
    ++tried;
    const Vector3d at =
        0.65 * opening.outer[0] + 0.35 * opening.outer[1] + 0.3 * (opening.outer[3] - opening.outer[0]);
    const RayHit hit = caster.cast(at + 0.01 * opening.normal, -opening.normal);
    ASSERT_TRUE(hit.found());
    const Element element = recipe.world.mesh.surfaces()[static_cast<std::size_t>(hit.surface)].element;
    EXPECT_NE(element, Element::wall);
    EXPECT_GT(hit.range_m, 0.02);
  }
  EXPECT_GT(tried, 50);
}

TEST(Mesh, APanelLosesTheAreaOfItsHoles) {
  Mesh mesh;
  const PlaneFrame frame{{1.0, 2.0, 0.0}, Vector3d::UnitX(), Vector3d::UnitZ()};
  mesh.add_panel(frame, {6.0, 3.0}, {{1.0, 0.8, 2.0, 2.2}, {3.0, 0.0, 4.0, 2.1}, {4.5, 0.8, 5.5, 2.2}},
                 surface_of(Element::wall));
  EXPECT_NEAR(mesh.surfaces()[0].area_m2, 18.0 - 1.4 - 2.1 - 1.4, 1e-12);
  EXPECT_NEAR(mesh.surfaces()[0].plane.normal.y(), -1.0, 1e-12);
}

TEST(Mesh, CoplanarFacesLookingTheSameWayBecomeOnePlane) {
  Mesh mesh;
  const auto square = [](double x, double z) {
    return std::vector<Vector3d>{{x, 0.0, z}, {x + 1.0, 0.0, z}, {x + 1.0, 1.0, z}, {x, 1.0, z}};
  };
  mesh.add_polygon(square(0.0, 1.0), surface_of(Element::floor));
  mesh.add_polygon(square(5.0, 1.0004), surface_of(Element::furniture));
  mesh.add_polygon(square(9.0, 1.01), surface_of(Element::furniture));
  std::vector<Vector3d> ceiling = square(3.0, 1.0);
  std::reverse(ceiling.begin(), ceiling.end());
  mesh.add_polygon(ceiling, surface_of(Element::ceiling));
  const MergedPlanes merged = merge_planes(mesh);
  EXPECT_EQ(merged.plane_of_surface, (std::vector<int>{0, 0, 1, 2}));
  EXPECT_NEAR(merged.planes[0].area_m2, 2.0, 1e-12);
}

/// Chairs may be pushed under their table; the pieces as such must not share floor.
TEST(Furniture, PiecesDoNotOverlapAndStayInTheirRoom) {
  SceneOptions options;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    options.seed = seed;
    const Recipe recipe = make_recipe(options);
    const Building& building = recipe.world.buildings[0];
    std::size_t pieces = 0;
    for (std::size_t room = 0; room < building.plan.rooms.size(); ++room) {
      for (std::size_t i = 0; i < building.occupied[room].size(); ++i) {
        const Footprint& a = building.occupied[room][i];
        for (std::size_t j = i + 1; j < building.occupied[room].size(); ++j) {
          const Footprint& b = building.occupied[room][j];
          if (!a.piece || !b.piece) continue;
          ++pieces;
          const Vector2d middle = 0.5 * (a.area[0] + a.area[2]);
          EXPECT_FALSE(contains(b.area, middle));
        }
      }
    }
    EXPECT_GT(pieces, 3U) << "seed " << seed;
  }
}

}  // namespace
}  // namespace limen
