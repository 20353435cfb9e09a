// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/simulate/buildings/opening_parts.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "limen/simulate/buildings/building.h"
#include "limen/simulate/scanner/ray_caster.h"

namespace limen {
namespace {

OpeningShape window(HeadForm head) {
  OpeningShape shape;
  shape.id = 0;
  shape.outer = {{1.0, 2.0, 0.5}, Vector3d::UnitX(), Vector3d::UnitZ()};
  shape.width_m = 1.2;
  shape.height_m = head == HeadForm::round ? 1.2 : 1.8;
  shape.thickness_m = 0.4;
  shape.mullions = 0;
  shape.head = head;
  shape.rise_m = 0.3;
  return shape;
}

/// Area of a circular segment of the given chord and height.
double segment_area(double chord, double rise) {
  const double radius = 0.5 * (0.25 * chord * chord + rise * rise) / rise;
  const double angle = 2.0 * std::asin(0.5 * chord / radius);
  return 0.5 * radius * radius * (angle - std::sin(angle));
}

TEST(OpeningShape, OutlinesHaveTheAreaOfTheirForm) {
  const double pi = std::numbers::pi;
  // The polygon lies in the curve: up to 1 % less.
  EXPECT_NEAR(signed_area(window(HeadForm::rectangular).outline()), 1.2 * 1.8, 1e-12);
  EXPECT_NEAR(signed_area(window(HeadForm::segmental).outline()), 1.2 * 1.5 + segment_area(1.2, 0.3), 3e-3);
  EXPECT_NEAR(signed_area(window(HeadForm::semicircle).outline()), 1.2 * 1.2 + 0.5 * pi * 0.36, 5e-3);
  EXPECT_NEAR(signed_area(window(HeadForm::round).outline()), pi * 0.36, 1e-2);
}

TEST(OpeningShape, OutlinesTouchTheirRectangleOnAllSides) {
  for (const HeadForm head :
       {HeadForm::rectangular, HeadForm::segmental, HeadForm::semicircle, HeadForm::round}) {
    const OpeningShape shape = window(head);
    Vector2d low(9.0, 9.0);
    Vector2d high(-9.0, -9.0);
    for (const Vector2d& p : shape.outline()) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    EXPECT_LT(low.norm(), 1e-9) << to_string(head);
    EXPECT_LT((high - Vector2d(shape.width_m, shape.height_m)).norm(), 1e-9) << to_string(head);
  }
}

TEST(OpeningShape, SpandrelsAndOutlineFillTheRectangle) {
  EXPECT_TRUE(spandrels(window(HeadForm::rectangular).outline(), {1.2, 1.8}).empty());
  for (const HeadForm head : {HeadForm::segmental, HeadForm::semicircle, HeadForm::round}) {
    const OpeningShape shape = window(head);
    double sum = signed_area(shape.outline());
    for (const auto& t : spandrels(shape.outline(), {shape.width_m, shape.height_m})) {
      const double part = signed_area({t[0], t[1], t[2]});
      EXPECT_GT(part, 0.0) << to_string(head);
      sum += part;
    }
    EXPECT_NEAR(sum, shape.width_m * shape.height_m, 1e-12) << to_string(head);
  }
}

/// Rays straight at the wall: inside the outline they pass to the window's parts, outside they meet the wall.
TEST(Building, CurvedHolesAreCutAsTheTruthSays) {
  PlanOptions plan;
  plan.main_bays_m = {3.0, 3.0, 3.0};
  plan.storeys = 3;
  FacadeOptions facade;
  facade.entrance = false;
  facade.ornament_share = 0.0;
  facade.curtain_share = 0.5;
  facade.storeys = {{.head = HeadForm::segmental}, {.head = HeadForm::semicircle}, {.head = HeadForm::round}};
  RandomStream random(3);
  World world;
  add_building(world, make_floor_plan(plan, random), facade, random);
  const RayCaster caster(world.mesh);
  std::size_t curved = 0;
  std::size_t through = 0;
  for (const TrueOpening& opening : world.openings) {
    if (opening.head == "rectangular" || !opening.exterior) continue;
    ++curved;
    const PlaneFrame frame{opening.outer[0], (opening.outer[1] - opening.outer[0]).normalized(),
                           Vector3d::UnitZ()};
    Ring ring;
    for (const Vector3d& p : opening.outer_outline) ring.push_back(frame.to_plane(p));
    const Vector2d size = frame.to_plane(opening.outer[2]);
    for (int i = 0; i < 400; ++i) {
      const Vector2d p(random.uniform(-0.1, 1.1) * size.x(), random.uniform(-0.1, 1.1) * size.y());
      const RayHit hit = caster.cast(frame.to_space(p) + 0.5 * opening.normal, -opening.normal);
      ASSERT_TRUE(hit.found());
      EXPECT_FALSE(hit.inside);
      EXPECT_EQ(hit.range_m > 0.5 + 1e-6, contains(ring, p)) << opening.head;
      const Element element = world.mesh.surfaces()[static_cast<std::size_t>(hit.surface)].element;
      EXPECT_EQ(element != Element::wall, contains(ring, p)) << opening.head;
      through += element == Element::glass ? 1U : 0U;
    }
    // From the room the hole is the same.
    const Vector3d corner = opening.inner[3] + 0.01 * (opening.inner[1] - opening.inner[0]);
    const RayHit back =
        caster.cast(corner - 0.02 * Vector3d::UnitZ() - 0.01 * opening.normal, opening.normal);
    ASSERT_TRUE(back.found());
    EXPECT_NEAR(back.range_m, 0.01, 1e-9) << "the wall fills the corner beside the arch";
  }
  EXPECT_GE(curved, 12U);
  EXPECT_GT(through, 1000U);
}

}  // namespace
}  // namespace limen
