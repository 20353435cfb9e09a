// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/geometry/joined_points.h"

#include <gtest/gtest.h>

#include "limen/base/random.h"
#include "limen/geometry/random_vectors.h"

namespace limen {
namespace {

TEST(JoinedPoints, HangTogetherOneByOne) {
  DisjointSets sets = joined_points({{0, 0, 0}, {0.9, 0, 0}, {1.8, 0, 0}, {2.9, 0, 0}, {-0.9, 0, 0}}, 1.0);
  EXPECT_EQ(sets.find(2), 0U);
  EXPECT_EQ(sets.find(4), 0U);
  EXPECT_EQ(sets.find(3), 3U);
}

TEST(JoinedPoints, AreThoseThatAllPairsJoin) {
  constexpr double kNearerM = 0.4;
  RandomStream random(7, 1);
  std::vector<Vector3d> points;
  for (int k = 0; k < 200; ++k)
    points.push_back(uniform_vector(Vector3d(-2, -2, -2), Vector3d(2, 2, 2), random));
  DisjointSets sets = joined_points(points, kNearerM);
  DisjointSets expected(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j)
      if ((points[i] - points[j]).norm() < kNearerM) expected.join(i, j);
  }
  for (std::size_t i = 0; i < points.size(); ++i) EXPECT_EQ(sets.find(i), expected.find(i)) << i;
}

}  // namespace
}  // namespace limen
