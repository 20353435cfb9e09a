// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/simulate/furnishing/layout.h"

#include <gtest/gtest.h>

#include "limen/simulate/furnishing/furnish_rooms.h"

namespace limen {
namespace {

World one_room(bool mirrored) {
  PlanOptions options;
  options.main_bays_m = {5.0};
  options.south_depth_m = 4.0;
  RandomStream random(1);
  FloorPlan plan = make_floor_plan(options, random);
  plan.rooms[0].design = 0;
  plan.rooms[0].design_origin = plan.rooms[0].outline[mirrored ? 1 : 0];
  if (mirrored) plan.rooms[0].design_x = -Vector2d::UnitX();
  World world;
  FacadeOptions facade;
  facade.entrance = false;
  add_building(world, plan, facade, random);
  return world;
}

TEST(Pieces, StayWithinTheirSizes) {
  for (int kind = 0; kind <= static_cast<int>(PieceKind::small_object); ++kind) {
    for (std::uint64_t seed = 1; seed < 6; ++seed) {
      const Piece piece{static_cast<PieceKind>(kind), seed, seed + 50};
      const Vector3d size = size_of(piece);
      Mesh mesh;
      add_piece(mesh, piece, {});
      ASSERT_GT(mesh.triangles().size(), 0U);
      for (const Vector3d& x : mesh.vertices()) {
        // Leaves, chairs pushed back and coats reach out a little.
        EXPECT_LT(std::abs(x.x()), 0.5 * size.x() + 0.3) << kind;
        EXPECT_GT(x.y(), -0.3) << kind;
        EXPECT_LT(x.y(), size.y() + 0.3) << kind;
        EXPECT_GT(x.z(), -0.2) << kind;
        EXPECT_LT(x.z(), size.z() + 0.5) << kind;
      }
    }
  }
}

TEST(Layout, HidesAboutTheShareOfWallsThatWasAsked) {
  const World world = one_room(false);
  const auto hidden = [&](double share) {
    double width = 0.0;
    for (const PlacedPiece& placed : make_layout(
             world, 0, 0,
             {.hide_share = share, .free_per_m2 = 0.0, .pictures_per_m2 = 0.0, .small_per_m2 = 0.0}, 7))
      width += size_of(placed.piece).x();
    return width / 17.0;
  };
  EXPECT_EQ(hidden(0.0), 0.0);
  EXPECT_GT(hidden(0.3), 0.25);
  EXPECT_LT(hidden(0.3), 0.5);
  EXPECT_GT(hidden(0.7), hidden(0.3));
}

TEST(Layout, OfAnotherDayIsPartlyTheSame) {
  const World world = one_room(false);
  const Layout layout = make_layout(world, 0, 0, {.hide_share = 0.5, .free_per_m2 = 0.2}, 3);
  ASSERT_GT(layout.size(), 5U);
  const PlacingOptions options{.shift_m = 0.0, .turn_rad = 0.0, .moved_share = 0.4, .removed_share = 0.1};
  std::size_t same = 0;
  std::size_t all = 0;
  for (std::uint64_t seed = 1; seed < 20; ++seed) {
    for (const PlacedPiece& placed : as_placed(layout, world, 0, 0, options, seed)) {
      ++all;
      for (const PlacedPiece& before : layout)
        same += placed.piece.seed == before.piece.seed && placed.back == before.back ? 1U : 0U;
    }
  }
  EXPECT_GT(same, all / 2);
  EXPECT_LT(same, all);
  EXPECT_LT(all, 19 * layout.size());
}

/// A room and its mirror image hold the same things at mirrored places.
TEST(Layout, IsMirroredWithItsRoom) {
  World left = one_room(false);
  World right = one_room(true);
  const std::size_t before = left.mesh.triangles().size();
  ASSERT_EQ(before, right.mesh.triangles().size());
  const PlacedPiece lamp{.piece = {PieceKind::floor_lamp, 4, 4}, .back = {0.6, 0.02}};
  add_layout(left, 0, 0, {lamp});
  add_layout(right, 0, 0, {lamp});
  const auto middle = [&](const World& world) {
    Vector3d low = Vector3d::Constant(1e9);
    Vector3d high = -low;
    for (std::size_t i = 3 * before; i < world.mesh.vertices().size(); ++i) {
      low = low.cwiseMin(world.mesh.vertices()[i]);
      high = high.cwiseMax(world.mesh.vertices()[i]);
    }
    return Vector3d(0.5 * (low + high));
  };
  ASSERT_GT(left.mesh.triangles().size(), before);
  const Ring& outline = left.buildings[0].plan.rooms[0].outline;
  const double centre = 0.5 * (outline[0].x() + outline[1].x());
  EXPECT_NEAR(middle(left).x() - centre, centre - middle(right).x(), 1e-9);
  EXPECT_NEAR(middle(left).y(), middle(right).y(), 1e-9);
}

}  // namespace
}  // namespace limen
