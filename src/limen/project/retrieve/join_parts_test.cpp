// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/retrieve/join_parts.h"

#include <algorithm>

#include "support/drawn_rooms.h"
#include <gtest/gtest.h>

#include "limen/project/retrieve/plan_view.h"
#include "limen/project/retrieve/seen_space.h"

namespace limen {
namespace {

bool never(std::size_t /*high*/, std::size_t /*low*/) {
  return false;
}

/// A scan of one room at a pose: what is in the building at x is in the scan at pose * x.
ScanDigest seen_from(ScanDigest scan, const Rigid3& pose) {
  for (PlaneDigest& plane : scan.planes) {
    plane.plane.normal = pose.rotation * plane.plane.normal;
    plane.centroid = pose * plane.centroid;
    plane.moments.sum = pose.rotation * plane.moments.sum;
    plane.moments.outer = pose.rotation * plane.moments.outer * pose.rotation.transpose();
    plane.plane.offset = plane.plane.normal.dot(plane.centroid);
  }
  for (Vector3d& station : scan.stations) station = pose * station;
  return scan;
}

/// Four rooms in a row: 5 x 4, 3 x 4, 6 x 4 and 4 x 4 m. The third is scanned twice.
struct Row {
  ScanDigest first = drawn_room({2.5, 2.0, 1.25}, 5.0, 4.0);
  ScanDigest second = drawn_room({6.7, 2.0, 1.25}, 3.0, 4.0);
  ScanDigest third = drawn_room({11.4, 2.0, 1.25}, 6.0, 4.0);
  ScanDigest fourth = drawn_room({16.6, 2.0, 1.25}, 4.0, 4.0);
};

/// Two parts: rooms 1 to 3, and rooms 3 and 4 of which every scan has axes of its own.
struct TwoParts {
  Rigid3 turned;
  Row row;
  Rigid3 alone = turn_and_shift(-1.1, {2.0, 5.0, -2.0});
  std::vector<ScanDigest> digests = {row.first, row.second, row.third, seen_from(row.third, turned),
                                     seen_from(row.fourth, alone)};
  std::vector<PlacedPart> parts = {{{0, 1, 2}, {Rigid3{}, Rigid3{}, Rigid3{}}},
                                   {{3, 4}, {Rigid3{}, turned* inverse(alone)}}};

  explicit TwoParts(const Vector3d& moved = Vector3d::Zero())
      : turned(turn_and_shift(0.7, Vector3d(-3.0, 11.0, 0.4) + moved)) {}
};

TEST(PartJoiner, TheTwoScansOfOneRoomComeFirst) {
  const TwoParts two;
  const PairList pairs = PartJoiner(two.digests).next_pairs(two.parts, never);
  ASSERT_FALSE(pairs.empty());
  EXPECT_EQ(pairs.front(), std::pair(std::size_t{3}, std::size_t{2}));
}

TEST(PartJoiner, WhereThePartsLieWithinAPixelOfTheirPlansDoesNotMatter) {
  for (const double x : {0.0, 0.05, 0.1, 0.15, 0.2}) {
    for (const double y : {0.0, 0.05, 0.1, 0.15, 0.2}) {
      const TwoParts two({x, y, 0.0});
      const PairList pairs = PartJoiner(two.digests).next_pairs(two.parts, never);
      ASSERT_FALSE(pairs.empty()) << x << ' ' << y;
      EXPECT_EQ(pairs.front(), std::pair(std::size_t{3}, std::size_t{2})) << x << ' ' << y;
    }
  }
}

TEST(PartJoiner, TheOrderOfPartsDoesNotMatter) {
  TwoParts two;
  const PairList pairs = PartJoiner(two.digests).next_pairs(two.parts, never);
  std::swap(two.parts[0], two.parts[1]);
  EXPECT_EQ(PartJoiner(two.digests).next_pairs(two.parts, never).front(), pairs.front());
}

TEST(PartJoiner, PairsThatWereTriedAreLeftOut) {
  const TwoParts two;
  const auto tried = [](std::size_t high, std::size_t low) { return high == 3 && low == 2; };
  for (const auto& pair : PartJoiner(two.digests).next_pairs(two.parts, tried))
    EXPECT_NE(pair, std::pair(std::size_t{3}, std::size_t{2}));
}

TEST(PartJoiner, PartsThatDidNotChangeAreNotMatchedAgain) {
  TwoParts two;
  PartJoiner joiner(two.digests);
  EXPECT_FALSE(joiner.next_pairs(two.parts, never).empty());
  EXPECT_TRUE(joiner.next_pairs(two.parts, never).empty());
  two.parts[0] = {{1, 2}, {Rigid3{}, Rigid3{}}};
  EXPECT_FALSE(joiner.next_pairs(two.parts, never).empty());
}

TEST(PartJoiner, TwoScansThatAreJoinedToNothingAreMatchedToo) {
  const TwoParts two;
  const std::vector<PlacedPart> alone = {{{2}, {Rigid3{}}}, {{3}, {Rigid3{}}}};
  const PairList pairs = PartJoiner(two.digests).next_pairs(alone, never);
  EXPECT_EQ(pairs, (PairList{{3, 2}}));
}

TEST(PartJoiner, ALookAlikeRoomWithWallsWhereTheOtherPartIsClearComesNowhere) {
  // Beside room 2 of one part are a room and a hall whose scanners looked at the walls between them; beside
  // the same room of the other part are three cupboards.
  Row row;
  ScanDigest hall = drawn_room({11.4, 2.0, 1.25}, 6.0, 4.0);
  for (const double y : {0.5, 1.5, 2.5, 3.5}) {
    for (const double z : {0.3, 0.9, 1.5, 2.1}) {
      hall.planes.push_back(rectangle({8.4, y, z}, Vector3d::UnitX(), 1.0, 0.6));
      row.first.planes.push_back(rectangle({5.0, y, z}, -Vector3d::UnitX(), 1.0, 0.6));
    }
  }
  ScanDigest cupboards;
  for (const double y : {0.8, 2.0, 3.2})
    cupboards.planes.push_back(rectangle({9.2, y, 1.25}, Vector3d::UnitX(), 1.2, 2.0));
  cupboards.stations = {Vector3d(11.0, 2.0, 1.25)};
  std::vector<ScanDigest> digests = {row.first, row.second, hall, row.second, cupboards};
  const std::vector<PlacedPart> parts = {{{0, 1, 2}, {Rigid3{}, Rigid3{}, Rigid3{}}},
                                         {{3, 4}, {Rigid3{}, Rigid3{}}}};
  for (const auto& [high, low] : PartJoiner(digests).next_pairs(parts, never))
    EXPECT_FALSE(high == 3 && low == 1);
  // Where the scanner did not look, nothing is against it.
  digests[2].stations.clear();
  digests[4].stations.clear();
  const PairList pairs = PartJoiner(digests).next_pairs(parts, never);
  EXPECT_NE(std::find(pairs.begin(), pairs.end(), std::pair(std::size_t{3}, std::size_t{1})), pairs.end());
}

TEST(PartJoiner, WhatLiesFarAwayChangesNothing) {
  TwoParts two;
  const PairList pairs = PartJoiner(two.digests).next_pairs(two.parts, never);
  PlaneDigest far = two.row.first.planes[0];
  far.centroid.x() += 80000.0;
  PlaneDigest wide = far;
  wide.moments.outer *= 1e10;  // 300 km
  for (ScanDigest& scan : two.digests) scan.planes.insert(scan.planes.end(), {far, wide});
  EXPECT_EQ(PartJoiner(two.digests).next_pairs(two.parts, never), pairs);
}

TEST(PlanImage, AHugePlanHasNoShifts) {
  std::vector<PlacedPlane> walls(2);
  for (PlacedPlane& wall : walls) {
    wall.normal = Vector3d::UnitX();
    wall.along = 5.0 * Vector3d::UnitY();
    wall.across = 1.2 * Vector3d::UnitZ();
    wall.area_m2 = 24.0;
  }
  const auto shifts = [&] {
    const PlanView plan(walls);
    std::vector<PlanPose> poses;
    PlanImage(plan).add_best_shifts(plan, 0.0, 5, poses);
    return poses.size();
  };
  walls[1].middle = {20.0, 0.0, 0.0};
  EXPECT_GT(shifts(), 0U);
  walls[1].middle = {90000.0, 90000.0, 0.0};
  EXPECT_EQ(shifts(), 0U);
}

TEST(SeenSpace, KnowsSurfaceAndWhatWasLookedThrough) {
  PlacedPlane wall;
  wall.middle = {4.0, 0.0, 0.0};
  wall.normal = -Vector3d::UnitX();
  wall.along = {0.0, 2.0, 0.0};
  wall.across = {0.0, 0.0, 1.2};
  wall.area_m2 = 9.6;
  wall.oriented = true;
  wall.scanner = Vector3d::Zero();
  SeenSpace space;
  space.add(wall);
  const auto at = [&](const Vector3d& x, const Vector3d& normal) { return space.at({x, normal, 1.0, true}); };
  EXPECT_EQ(at({4.05, 0.7, 0.4}, -Vector3d::UnitX()), SeenSpace::Finding::surface);
  EXPECT_EQ(at({4.05, 0.7, 0.4}, Vector3d::UnitX()), SeenSpace::Finding::unknown);  // its other side
  EXPECT_EQ(at({2.0, 0.0, 0.0}, Vector3d::UnitX()), SeenSpace::Finding::looked_through);
  EXPECT_EQ(at({5.0, 0.0, 0.0}, Vector3d::UnitX()), SeenSpace::Finding::unknown);  // behind it
  const auto way = [&](double x, const Vector3d& normal) {
    return space.way_to_surface({{x, 0.7, 0.4}, normal, 1.0, true});
  };
  EXPECT_NEAR(way(3.7, -Vector3d::UnitX()).value_or(9.0), -0.3, 1e-9);
  EXPECT_NEAR(way(4.35, -Vector3d::UnitX()).value_or(9.0), 0.35, 1e-9);
  EXPECT_FALSE(way(4.35, Vector3d::UnitX()));  // its other side
  EXPECT_FALSE(way(4.5, -Vector3d::UnitX()));
}

TEST(PlanImage, FindsTheShiftOfAPlanOnItself) {
  std::vector<PlacedPlane> walls(3);
  const auto set = [&](std::size_t k, const Vector3d& middle, const Vector3d& normal, double half) {
    walls[k].middle = middle;
    walls[k].normal = normal;
    walls[k].along = half * Vector3d::UnitZ().cross(normal);
    walls[k].across = Vector3d(0.0, 0.0, 1.2);
    walls[k].area_m2 = 4.8 * half;
    walls[k].oriented = true;
  };
  set(0, {3.0, 0.0, 1.2}, -Vector3d::UnitX(), 2.0);
  set(1, {0.0, 2.0, 1.2}, -Vector3d::UnitY(), 3.0);
  set(2, {-3.0, 1.0, 1.2}, Vector3d::UnitX(), 1.0);
  const PlanView here(walls);
  for (PlacedPlane& wall : walls) wall.middle += Vector3d(7.0, -4.0, 0.0);
  const PlanView there(walls);
  ASSERT_EQ(here.main_directions().size(), 1U);
  std::vector<PlanPose> poses;
  PlanImage(here).add_best_shifts(there, 0.0, 1, poses);
  ASSERT_EQ(poses.size(), 1U);
  EXPECT_LT((poses[0].shift - Vector2d(-7.0, 4.0)).norm(), 0.26);
}

}  // namespace
}  // namespace limen
