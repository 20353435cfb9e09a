// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/control/match_points.h"

#include <gtest/gtest.h>

#include "limen/geometry/random_vectors.h"

namespace limen {
namespace {

constexpr double kMatchSigmaM = 0.001;

std::vector<MeasuredPoint> surveyed_points(std::size_t count, RandomStream& random) {
  std::vector<MeasuredPoint> known;
  for (std::size_t k = 0; k < count; ++k)
    known.push_back({uniform_vector(Vector3d(0, 0, 0), Vector3d(20, 15, 6), random), kMatchSigmaM});
  return known;
}

/// Some of the known points in another frame, with noise.
std::vector<MeasuredPoint> seen_of(const std::vector<MeasuredPoint>& known, const std::vector<int>& which,
                                   RandomStream& random) {
  const Rigid3 motion{uniform_rotation(random), {3, 4, 5}};
  std::vector<MeasuredPoint> seen;
  for (const int k : which)
    seen.push_back(
        {motion * known[static_cast<std::size_t>(k)].x + kMatchSigmaM * normal_vector(random), kMatchSigmaM});
  return seen;
}

TEST(MatchPoints, NamesSeenPointsByTheirDistancesAndLeavesStrangersOut) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    RandomStream random(seed, 3);
    const std::vector<MeasuredPoint> known = surveyed_points(30, random);
    std::vector<MeasuredPoint> seen = seen_of(known, {4, 17, 9, 22, 1}, random);
    seen.insert(seen.begin() + 2,
                {uniform_vector(Vector3d(0, 0, 0), Vector3d(9, 9, 9), random), kMatchSigmaM});
    EXPECT_EQ(match_points(seen, known), (std::vector<int>{4, 17, -1, 9, 22, 1})) << seed;
  }
}

TEST(MatchPoints, ThreePointsSufficeAmongFewAndNotAmongVeryMany) {
  RandomStream random(5, 3);
  const std::vector<MeasuredPoint> few = surveyed_points(6, random);
  EXPECT_EQ(match_points(seen_of(few, {5, 0, 3}, random), few), (std::vector<int>{5, 0, 3}));
  const std::vector<MeasuredPoint> many = surveyed_points(300, random);
  EXPECT_EQ(match_points(seen_of(many, {5, 0, 3}, random), many), (std::vector<int>{-1, -1, -1}));
}

TEST(MatchPoints, NoNameIsGuessed) {
  RandomStream random(6, 3);
  // Strangers; a rectangle, which fits itself turned; points on a line.
  const std::vector<MeasuredPoint> known = surveyed_points(12, random);
  EXPECT_EQ(match_points(surveyed_points(8, random), known), std::vector<int>(8, -1));
  const std::vector<MeasuredPoint> rectangle = {{{0, 0, 0}}, {{4, 0, 0}}, {{4, 3, 0}}, {{0, 3, 0}}};
  EXPECT_EQ(match_points(rectangle, rectangle), std::vector<int>(4, -1));
  const std::vector<MeasuredPoint> line = {{{0, 0, 0}}, {{1, 0, 0}}, {{3, 0, 0}}, {{7, 0, 0}}};
  EXPECT_EQ(match_points(line, line), std::vector<int>(4, -1));
  EXPECT_EQ(match_points(seen_of(known, {1, 2}, random), known), std::vector<int>(2, -1));
}

TEST(MatchPoints, AMirrorImageIsNoMatch) {
  RandomStream random(7, 3);
  const std::vector<MeasuredPoint> known = surveyed_points(6, random);
  std::vector<MeasuredPoint> seen = known;
  for (MeasuredPoint& point : seen) point.x.x() = -point.x.x();
  for (const int k : match_points(seen, known)) EXPECT_EQ(k, -1);
}

}  // namespace
}  // namespace limen
