// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/match/planes/axis_pairs.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "limen/base/random.h"
#include "limen/geometry/random_vectors.h"

namespace limen {
namespace {

constexpr double kTolerance = 0.06;

/// Planes of both scans across one axis, at random.
AxisPairs random_pairs(std::size_t count) {
  RandomStream random(7, 1);
  AxisPairs along;
  along.axis.frame = make_frame({Vector3d::UnitZ(), 0.0}, Vector3d::Zero());
  for (std::size_t i = 0; i < count; ++i) {
    const auto box = [&] {
      AxisBox made;
      made.low = uniform_vector(Vector2d(-5.0, -5.0), Vector2d(4.0, 4.0), random);
      made.high = made.low + uniform_vector(Vector2d(0.2, 0.2), Vector2d(3.0, 3.0), random);
      return made;
    };
    along.source_boxes.push_back({box(), box()});
    along.target_boxes.push_back({box()});
    along.pairs.push_back({random.uniform(-3.0, 3.0), i, i, random.uniform(0.1, 4.0)});
  }
  std::sort(along.pairs.begin(), along.pairs.end(),
            [](const ShiftPair& a, const ShiftPair& b) { return a.shift < b.shift; });
  along.index(kTolerance);
  return along;
}

TEST(AxisPairs, SupportAtAShiftIsTheSupportThere) {
  const AxisPairs along = random_pairs(200);
  RandomStream random(8, 1);
  double most = 0.0;
  int ended_early = 0;
  for (int k = 0; k < 500; ++k) {
    const Vector3d shift = uniform_vector(Vector3d(-3.0, -3.0, -3.2), Vector3d(3.0, 3.0, 3.2), random);
    const double value = along.axis.direction.dot(shift);
    const ShiftSupport there = along.support_at(value, kTolerance);
    const Vector2d in_plane(along.axis.frame.u.dot(shift), along.axis.frame.v.dot(shift));
    const double support = along.support(shift, kTolerance);
    EXPECT_EQ(there.at(in_plane, -1.0), support);
    EXPECT_GE(there.most(), support);
    most = std::max(most, support);
    for (const double enough : {0.5 * support, 0.99 * support}) {
      if (support > 0.0) {
        EXPECT_EQ(there.at(in_plane, enough), support);
      }
    }
    for (const double enough : {support + 0.01, 2.0 * support + 0.1}) {
      const double stated = there.at(in_plane, enough);
      EXPECT_LE(stated, enough);
      EXPECT_GE(stated, support - 1e-9);
      ended_early += stated != support ? 1 : 0;
    }
  }
  EXPECT_GT(most, 0.0);
  EXPECT_GT(ended_early, 50);
}

TEST(AxisPairs, NothingGivesMoreThanTheBoundWhereOneWayAcrossIsKnown) {
  const AxisPairs along = random_pairs(200);
  RandomStream random(10, 1);
  int tighter = 0;
  for (int k = 0; k < 500; ++k) {
    const ShiftSupport there = along.support_at(random.uniform(-3.2, 3.2), kTolerance);
    const double angle = k % 2 == 0 ? 0.0 : random.uniform(0.0, 6.28);
    const Vector2d way(std::cos(angle), std::sin(angle));
    const Vector2d across(-way.y(), way.x());
    const double along_m = random.uniform(-4.0, 4.0);
    const double bound = there.most_where(way, {along_m}).front();
    for (const double across_m : {-2.0, -0.5, 0.0, 0.7, 3.0})
      EXPECT_GE(bound, there.at(along_m * way + across_m * across, -1.0));
    tighter += bound < 0.9 * there.most() ? 1 : 0;
  }
  EXPECT_GT(tighter, 100);
}

TEST(AxisPairs, NothingGivesMoreThanTheBound) {
  const AxisPairs along = random_pairs(200);
  RandomStream random(9, 1);
  for (int k = 0; k < 2000; ++k) {
    const double value = random.uniform(-3.5, 3.5);
    EXPECT_GE(along.most_near(value), along.support_at(value, kTolerance).most());
  }
  EXPECT_EQ(along.most_near(-9.0), 0.0);
  EXPECT_EQ(along.most_near(9.0), 0.0);
}

TEST(AxisPairs, PairsAreFoundFromAnyValue) {
  const AxisPairs along = random_pairs(50);
  for (const double value : {-9.0, -3.0, -0.5, 0.0, 0.01, 1.7, 2.99, 9.0}) {
    const auto wanted = std::count_if(along.pairs.begin(), along.pairs.end(),
                                      [&](const ShiftPair& pair) { return pair.shift < value; });
    EXPECT_EQ(along.first_from(value), static_cast<std::size_t>(wanted));
  }
}

}  // namespace
}  // namespace limen
