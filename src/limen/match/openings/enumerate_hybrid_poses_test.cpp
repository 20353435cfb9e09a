// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/match/openings/enumerate_hybrid_poses.h"

#include "support/synthetic_openings.h"
#include <gtest/gtest.h>

#include "limen/match/planes/plane_shifts.h"

namespace limen {
namespace {

using synthetic::add_wall;
using synthetic::rectangle;
using synthetic::Wall;
using synthetic::WallSight;
using synthetic::Window;

/// A street front with a room behind its first three windows; what a scan outside and one inside have of it.
struct House {
  double thickness_m = 0.42;
  Rigid3 target_from_source{rotation_exp(Vector3d(0.0, 0.0, 2.0)), Vector3d(20.0, -7.0, 1.5)};
  Features outside;  // the target
  Features inside;   // the source
  Vector3d middle = Vector3d(4.0, 2.0, 1.8);

  explicit House(double noise_m = 0.004) {
    const std::vector<Window> all = synthetic::irregular();
    const Wall front{Vector3d::Zero(), Vector3d::UnitX(), 14.0, 9.0, all};
    const Wall room{Vector3d::Zero(), Vector3d::UnitX(), 9.0, 3.0, {all.begin(), all.begin() + 3}};
    add_wall(outside, front, {false, thickness_m, noise_m, 0.0, 1});
    add_wall(inside, room, {true, thickness_m, noise_m, 0.0, 2});
    for (PlanarPolygon* plane : {&inside.planes[0]}) {  // the room's own wall is shorter
      plane->centroid = Vector3d(4.5, thickness_m, 1.5);
    }
    outside = synthetic::moved(target_from_source, outside);
  }

  /// The back wall of the room, 5 m behind the front, whole inside and in strips outside.
  void show_back_wall() {
    const auto back = [](double left, double width) {
      return rectangle(Vector3d(left, 5.0, 0.0), Vector3d::UnitX(), Vector3d::UnitZ(), width, 2.8);
    };
    inside.planes.push_back(back(0.0, 9.0));
    Features strips;
    strips.planes = {back(1.5, 1.0), back(6.0, 1.5)};
    for (PlanarPolygon& strip : strips.planes) strip.interior = true;
    strips = synthetic::moved(target_from_source, strips);
    outside.planes.insert(outside.planes.end(), strips.planes.begin(), strips.planes.end());
  }

  [[nodiscard]] double error(const Rigid3& pose) const {
    return (pose * middle - target_from_source * middle).norm();
  }
};

TEST(PlaneShifts, FindsTheShiftThatLaysPlanesOnEachOther) {
  Features a;
  Features b;
  a.planes = {rectangle(Vector3d(0.0, 5.0, 0.0), Vector3d::UnitX(), Vector3d::UnitZ(), 4.0, 2.0)};
  b.planes = {rectangle(Vector3d(1.0, 5.3, 0.0), Vector3d::UnitX(), Vector3d::UnitZ(), 1.0, 1.0),
              rectangle(Vector3d(9.0, 5.1, 0.0), Vector3d::UnitX(), Vector3d::UnitZ(), 1.0, 1.0),
              rectangle(Vector3d(2.0, 5.2, 0.0), -Vector3d::UnitX(), Vector3d::UnitZ(), 1.0, 1.0)};
  const PlaneShiftFinder finder(a, b, Vector3d::UnitZ(), Vector3d::UnitZ());
  const auto shifts = finder.along(Rigid3{}, Vector3d::UnitY(), -1.0, 1.0);
  ASSERT_EQ(shifts.size(), 1U);  // the second lies beside it, the third was seen from behind
  EXPECT_NEAR(shifts[0].shift_m, 0.3, 1e-12);
  EXPECT_NEAR(shifts[0].overlap_m2, 1.0, 1e-9);
  EXPECT_EQ(shifts[0].target, 0);
  EXPECT_TRUE(finder.along(Rigid3{}, Vector3d::UnitX(), -1.0, 1.0).empty());
  EXPECT_TRUE(finder.along(Rigid3{}, Vector3d::UnitY(), -0.2, 0.2).empty());
}

TEST(PlaneShifts, PairsThatAgreeAreOneShift) {
  const std::vector<PlaneShift> shifts = {
      {-0.5, 1.0, 0, 0}, {0.20, 1.0, 1, 1}, {0.22, 3.0, 2, 2}, {0.9, 2.0, 3, 3}};
  const auto common = common_shifts(shifts, 0.06, 2);
  ASSERT_EQ(common.size(), 2U);
  EXPECT_NEAR(common[0].shift_m, 0.2155, 0.002);
  EXPECT_NEAR(common[1].shift_m, 0.9, 1e-12);
}

TEST(EnumerateHybridPoses, PlanesSeenThroughTheWindowsHoldTheNormal) {
  House house;
  house.show_back_wall();
  const auto poses = enumerate_hybrid_poses(house.inside, house.outside);
  ASSERT_FALSE(poses.empty());
  const HybridPose& best = poses.front();
  EXPECT_NEAR(best.thickness_m, house.thickness_m, 0.001);
  EXPECT_LT(house.error(best.target_from_source), 0.02);
  EXPECT_NEAR(best.support_m2, 2.5 * 2.8, 0.5);
  EXPECT_EQ(best.opening.matched_openings, 3);
}

TEST(EnumerateHybridPoses, WithoutSuchPlanesThicknessesAreAssumed) {
  const House house;
  const auto poses = enumerate_hybrid_poses(house.inside, house.outside);
  ASSERT_FALSE(poses.empty());
  for (const HybridPose& pose : poses) {
    if (pose.opening.sides == WallSides::same) continue;
    // Never thickness zero, to which the printed method pulls.
    EXPECT_GE(pose.thickness_m, 0.05);
  }
}

TEST(EnumerateHybridPoses, TheUsersThicknessComesFirst) {
  const House house;
  HybridPoseOptions options;
  options.wall_thickness_m = house.thickness_m;
  const auto poses = enumerate_hybrid_poses(house.inside, house.outside, options);
  ASSERT_FALSE(poses.empty());
  EXPECT_LT(house.error(poses.front().target_from_source), 0.02);
  options.wall_thickness_m = 1.8;  // beyond the usual range: the user knows
  EXPECT_NEAR(enumerate_hybrid_poses(house.inside, house.outside, options).front().thickness_m, 1.8, 1e-9);
}

TEST(EnumerateHybridPoses, RevealsThatReachThroughHoldTheNormal) {
  House house;
  house.inside.openings[1].reveal_depth_m = 0.42;
  house.inside.openings[1].reveal_sigma_m = 0.008;
  house.inside.openings[1].reveal_complete = true;
  const auto poses = enumerate_hybrid_poses(house.inside, house.outside);
  ASSERT_FALSE(poses.empty());
  EXPECT_EQ(poses.front().thickness_m, 0.42);
  EXPECT_LT(house.error(poses.front().target_from_source), 0.02);
}

TEST(EnumerateHybridPoses, OfTheSameFaceTheWholeWallOverlaps) {
  const Wall front{Vector3d::Zero(), Vector3d::UnitX(), 14.0, 9.0, synthetic::irregular()};
  Features one;
  Features other;
  add_wall(one, front, {});
  add_wall(other, front, {});
  const auto poses = enumerate_hybrid_poses(one, other);
  ASSERT_FALSE(poses.empty());
  EXPECT_EQ(poses.front().opening.sides, WallSides::same);
  EXPECT_NEAR(poses.front().support_m2, 14.0 * 9.0, 1.0);
}

}  // namespace
}  // namespace limen
