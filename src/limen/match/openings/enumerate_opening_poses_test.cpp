// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/match/openings/enumerate_opening_poses.h"

#include <cmath>

#include "support/synthetic_openings.h"
#include <gtest/gtest.h>

#include "limen/base/angles.h"
#include "limen/base/parallel.h"
#include "limen/geometry/random_vectors.h"

namespace limen {
namespace {

using synthetic::add_wall;
using synthetic::Wall;
using synthetic::WallSight;
using synthetic::Window;

Wall south_wall(std::vector<Window> windows, double width = 14.0) {
  return {Vector3d(0.0, 0.0, 0.0), Vector3d::UnitX(), width, 9.0, std::move(windows)};
}

Wall east_wall(std::vector<Window> windows) {
  return {Vector3d(14.0, 0.0, 0.0), Vector3d::UnitY(), 10.0, 9.0, std::move(windows)};
}

Features seen(const std::vector<Wall>& walls, const WallSight& sight) {
  Features features;
  for (const Wall& wall : walls) add_wall(features, wall, sight);
  return features;
}

Rigid3 yaw_and_shift(double yaw_deg, const Vector3d& shift) {
  return {rotation_exp(Vector3d(0.0, 0.0, radians(yaw_deg))), shift};
}

/// Error of a pose in the plane of its wall, at a point near the openings.
double error_in_wall(const OpeningPose& pose, const Rigid3& truth, const Vector3d& point) {
  const Vector3d off = pose.target_from_source * point - truth * point;
  return (off - off.dot(pose.wall_normal) * pose.wall_normal).norm();
}

double angle_off(const OpeningPose& pose, const Rigid3& truth) {
  return degrees(rotation_angle(pose.target_from_source.rotation.transpose() * truth.rotation));
}

/// Places in the list that lie within 5 cm in the wall and 1 degree of the truth.
std::vector<std::size_t> true_places(const std::vector<OpeningPose>& poses, const Rigid3& truth,
                                     const Vector3d& point) {
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (error_in_wall(poses[i], truth, point) < 0.05 && angle_off(poses[i], truth) < 1.0) places.push_back(i);
  }
  return places;
}

TEST(EnumerateOpeningPoses, AnIrregularFacadeIsMatchedFromInsideAndOutside) {
  const std::vector<Window> all = synthetic::irregular();
  const std::vector<Window> room(all.begin(), all.begin() + 3);
  const Rigid3 truth = yaw_and_shift(137.0, Vector3d(20.0, -7.0, 1.5));
  const Features outside = synthetic::moved(truth, seen({south_wall(all)}, {false, 0.4, 0.005, 0.0, 1}));
  const Features inside = seen({south_wall(room)}, {true, 0.4, 0.005, 0.0, 2});
  const Vector3d middle(4.0, 0.4, 1.8);
  const auto poses = enumerate_opening_poses(inside, outside);
  ASSERT_FALSE(poses.empty());
  const OpeningPose& best = poses.front();
  EXPECT_EQ(best.sides, WallSides::opposite);
  EXPECT_LT(error_in_wall(best, truth, middle), 0.02);
  EXPECT_LT(angle_off(best, truth), 0.1);
  EXPECT_EQ(best.matched_openings, 3);
  EXPECT_FALSE(best.thickness_held);
  EXPECT_EQ(best.source_wall, 0);
  EXPECT_EQ(best.target_wall, 0);
  EXPECT_NEAR(best.support_m, 2.0 * (2.7 + 2.7 + 3.4), 0.5);
  // Shifted by a window the distance is larger, and the list is in its order.
  for (std::size_t i = 1; i < poses.size(); ++i) {
    EXPECT_GE(poses[i].distance, poses[i - 1].distance);
    if (error_in_wall(poses[i], truth, middle) > 0.3) {
      EXPECT_GT(poses[i].distance, best.distance + 0.01);
    }
  }
  // The other way round, too.
  const auto back = enumerate_opening_poses(outside, inside);
  ASSERT_FALSE(back.empty());
  EXPECT_LT(error_in_wall(back.front(), inverse(truth), truth * middle), 0.02);
}

TEST(EnumerateOpeningPoses, TheNormalIsAnAssumptionUntilASecondWallHoldsIt) {
  const std::vector<Window> all = synthetic::irregular();
  const Rigid3 truth = yaw_and_shift(-60.0, Vector3d(3.0, 5.0, -1.0));
  const Features outside = synthetic::moved(
      truth, seen({south_wall(all), east_wall(synthetic::grid(3, 2, 3.1))}, {false, 0.4, 0.004, 0.0, 3}));
  const WallSight in{true, 0.37, 0.004, 0.0, 4};
  const Features one_wall = seen({south_wall({all[3]})}, in);
  const auto free = enumerate_opening_poses(one_wall, outside);
  EXPECT_FALSE(free.empty());
  for (const OpeningPose& pose : free) EXPECT_EQ(pose.thickness_held, pose.sides == WallSides::same);
  // A corner room: windows in two walls.
  const Features corner =
      seen({south_wall({all[2], all[3]}), east_wall({synthetic::grid(3, 2, 3.1)[0]})}, in);
  const auto poses = enumerate_opening_poses(corner, outside);
  ASSERT_FALSE(poses.empty());
  EXPECT_TRUE(poses.front().thickness_held);
  EXPECT_NEAR(poses.front().thickness_m, 0.37, 0.02);
  const Vector3d middle(9.0, 1.0, 1.5);
  EXPECT_LT((poses.front().target_from_source * middle - truth * middle).norm(), 0.03);
  EXPECT_EQ(poses.front().matched_openings, 3);
}

TEST(EnumerateOpeningPoses, ARegularFacadeListsEveryShift) {
  const auto all = synthetic::grid(8, 3);
  const Rigid3 truth = yaw_and_shift(10.0, Vector3d(1.0, 2.0, 3.0));
  const Features outside =
      synthetic::moved(truth, seen({south_wall(all, 22.0)}, {false, 0.3, 0.004, 0.0, 5}));
  const Features inside = seen({south_wall({all[2], all[3]}, 22.0)}, {true, 0.3, 0.004, 0.0, 6});
  OpeningPoseOptions options;
  options.thicknesses_m = {0.3};
  const auto poses = enumerate_opening_poses(inside, outside, options);
  int full = 0;
  for (const OpeningPose& pose : poses) {
    if (pose.sides == WallSides::same || pose.matched_openings < 2) continue;
    ++full;
    const Vector3d off = truth.rotation.transpose() * (pose.target_from_source * Vector3d(7.0, 0.3, 1.5) -
                                                       truth * Vector3d(7.0, 0.3, 1.5));
    EXPECT_NEAR(off.x() / 2.5, std::round(off.x() / 2.5), 0.02);
    EXPECT_NEAR(off.z() / 3.0, std::round(off.z() / 3.0), 0.02);
  }
  EXPECT_EQ(full, 7 * 3);  // no two alike: each shift once
  EXPECT_EQ(true_places(poses, truth, Vector3d(7.0, 0.3, 1.5)).size(), 1U);
}

TEST(EnumerateOpeningPoses, TheHouseAcrossTheStreetDoesNotCrowdOutTheRoomsWindow) {
  // The station sees its own window, and through it twelve of a regular house which fit the long regular
  // façade in very many places. Only the own window fits the true pose.
  const Window own{3.0, 1.0, 1.9, 2.1};
  std::vector<Window> all = synthetic::grid(16, 3);
  all.push_back({44.0, 1.0, own.width, own.height});
  const Features outside = seen({south_wall(all, 50.0)}, {});
  const Wall room{Vector3d(41.0, 0.0, 0.0), Vector3d::UnitX(), 6.0, 3.0, {own}};
  Features inside = seen({room}, {true, 0.4, 0.0, 0.0, 1});
  const Wall across{Vector3d(60.0, -20.0, 0.0), -Vector3d::UnitX(), 14.0, 9.0, synthetic::grid(4, 3)};
  add_wall(inside, across, {});
  OpeningPoseOptions options;
  options.thicknesses_m = {0.4};
  options.max_poses = 12;
  const auto poses = enumerate_opening_poses(inside, outside, options);
  EXPECT_FALSE(true_places(poses, Rigid3{}, Vector3d(45.0, 0.4, 2.0)).empty());
}

TEST(EnumerateOpeningPoses, OneWindowGivesAPosePerWindowOfItsSize) {
  std::vector<Window> all = synthetic::grid(4, 1);
  all.push_back({11.5, 1.0, 2.4, 1.5});
  const Features outside = seen({south_wall(all)}, {});
  const Features inside = seen({south_wall({all[1]})}, {true, 0.4, 0.0, 0.0, 1});
  OpeningPoseOptions options;
  options.thicknesses_m = {0.4};
  auto poses = enumerate_opening_poses(inside, outside, options);
  std::erase_if(poses, [](const OpeningPose& pose) { return pose.sides == WallSides::same; });
  EXPECT_EQ(poses.size(), 4U);
  EXPECT_EQ(true_places(poses, Rigid3{}, Vector3d(4.0, 0.4, 1.8)).size(), 1U);
  for (const OpeningPose& pose : poses) EXPECT_NEAR(pose.distance, poses.front().distance, 1e-9);
}

TEST(EnumerateOpeningPoses, EdgesThatWereNotSeenDoNotCount) {
  const std::vector<Window> all = synthetic::irregular();
  const Features outside = seen({south_wall(all)}, {false, 0.4, 0.003, 0.0, 7});
  Features inside = seen({south_wall({all[0], all[1], all[2]})}, {true, 0.4, 0.003, 0.0, 8});
  // A curtain hides half of the second window, seen from inside its right half: the edge lies anywhere.
  Opening& half = inside.openings[1];
  half.corners[1] += 0.6 * (half.corners[0] - half.corners[1]).normalized();
  half.corners[2] += 0.6 * (half.corners[3] - half.corners[2]).normalized();
  half.edge_sigma_m[1] = 1.0;
  const Vector3d middle(4.0, 0.4, 1.8);
  const auto poses = enumerate_opening_poses(inside, outside);
  ASSERT_FALSE(poses.empty());
  EXPECT_LT(error_in_wall(poses.front(), Rigid3{}, middle), 0.02);
  EXPECT_EQ(poses.front().matched_openings, 3);
  // Alone it is aligned on the edges that were seen.
  inside.openings = {half};
  const auto alone = enumerate_opening_poses(inside, outside);
  EXPECT_FALSE(true_places(alone, Rigid3{}, middle).empty());
  // Without a vertical edge nothing can be said.
  inside.openings[0].edge_sigma_m[3] = 1.0;
  EXPECT_TRUE(enumerate_opening_poses(inside, outside).empty());
}

TEST(EnumerateOpeningPoses, SplayedRevealsAreAlignedByTheirMiddles) {
  const std::vector<Window> all = synthetic::irregular();
  const Features outside = seen({south_wall(all)}, {});
  const Features inside = seen({south_wall({all[0], all[1], all[2]})}, {true, 0.4, 0.0, 0.1, 1});
  const auto poses = enumerate_opening_poses(inside, outside);
  ASSERT_FALSE(poses.empty());
  EXPECT_LT(error_in_wall(poses.front(), Rigid3{}, Vector3d(4.0, 0.4, 1.8)), 0.01);
}

TEST(EnumerateOpeningPoses, WithoutGravityAnyRotationIsFound) {
  RandomStream random(9);
  const std::vector<Window> all = synthetic::irregular();
  for (int trial = 0; trial < 20; ++trial) {
    const auto any = [&] { return normal_vector(random); };
    const Rigid3 truth{rotation_exp(2.0 * any()), 10.0 * any()};
    const Features outside = synthetic::moved(truth, seen({south_wall(all)}, {false, 0.4, 0.004, 0.0, 10}));
    const Features inside =
        seen({south_wall({all[0], all[1], all[2]})}, {true, 0.4, 0.004, 0.0, 11 + random.below(99)});
    OpeningPoseOptions options;
    options.gravity_known = false;
    const auto poses = enumerate_opening_poses(inside, outside, options);
    ASSERT_FALSE(poses.empty());
    EXPECT_LT(error_in_wall(poses.front(), truth, Vector3d(4.0, 0.4, 1.8)), 0.02);
    EXPECT_LT(angle_off(poses.front(), truth), 0.6);
  }
}

TEST(EnumerateOpeningPoses, TwoScansFromOneSideShareTheFace) {
  const std::vector<Window> all = synthetic::irregular();
  const Rigid3 truth = yaw_and_shift(80.0, Vector3d(-4.0, 2.0, 0.5));
  const Features one = seen({south_wall(all)}, {false, 0.4, 0.004, 0.0, 12});
  const Features other = synthetic::moved(truth, seen({south_wall(all)}, {false, 0.4, 0.004, 0.0, 13}));
  const auto poses = enumerate_opening_poses(one, other);
  ASSERT_FALSE(poses.empty());
  EXPECT_EQ(poses.front().sides, WallSides::same);
  EXPECT_TRUE(poses.front().thickness_held);
  EXPECT_NEAR(poses.front().thickness_m, 0.0, 0.01);
  const Vector3d middle(6.0, 0.0, 3.0);
  EXPECT_LT((poses.front().target_from_source * middle - truth * middle).norm(), 0.02);
}

TEST(EnumerateOpeningPoses, RevealsThatReachThroughProposeTheThickness) {
  const Features outside = seen({south_wall({{2.0, 1.0, 1.2, 1.5}})}, {});
  Features inside = seen({south_wall({{2.0, 1.0, 1.2, 1.5}})}, {true, 0.77, 0.0, 0.0, 1});
  inside.openings[0].reveal_depth_m = 0.77;
  inside.openings[0].reveal_sigma_m = 0.01;
  inside.openings[0].reveal_complete = true;
  bool found = false;
  for (const OpeningPose& pose : enumerate_opening_poses(inside, outside)) {
    found = found || std::abs(pose.thickness_m - 0.77) < 0.01;
  }
  EXPECT_TRUE(found);
}

TEST(EnumerateOpeningPoses, IsTheSameForAnyNumberOfThreads) {
  const auto all = synthetic::grid(8, 3);
  const Features outside = seen({south_wall(all, 22.0)}, {false, 0.3, 0.01, 0.0, 5});
  const Features inside = seen({south_wall({all[2], all[3]}, 22.0)}, {true, 0.3, 0.01, 0.0, 6});
  set_thread_count(1);
  const auto one = enumerate_opening_poses(inside, outside);
  set_thread_count(2);
  const auto two = enumerate_opening_poses(inside, outside);
  set_thread_count(0);
  ASSERT_EQ(one.size(), two.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].distance, two[i].distance);
    EXPECT_EQ(to_matrix(one[i].target_from_source), to_matrix(two[i].target_from_source));
  }
}

TEST(EnumerateOpeningPoses, NothingInOneScanGivesNothing) {
  const Features outside = seen({south_wall(synthetic::irregular())}, {});
  EXPECT_TRUE(enumerate_opening_poses(Features{}, outside).empty());
  EXPECT_TRUE(enumerate_opening_poses(outside, Features{}).empty());
}

}  // namespace
}  // namespace limen
