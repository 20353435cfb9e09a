// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/planes/merge_planes.h"

#include <gtest/gtest.h>

#include "limen/base/angles.h"
#include "limen/base/random.h"
#include "limen/geometry/random_vectors.h"

namespace limen {
namespace {

/// A square piece of an upright wall: middle, size, turn about the vertical; 2 mm noise.
PointMoments piece(const Vector3d& middle, double size_m, double turn_deg = 0.0, int count = 4000) {
  RandomStream random(7);
  const Vector3d along(std::cos(radians(turn_deg)), std::sin(radians(turn_deg)), 0.0);
  const Vector3d normal(-along.y(), along.x(), 0.0);
  PointMoments moments;
  for (int i = 0; i < count; ++i) {
    const double off = 0.002 * random.normal();
    const Vector2d in = size_m * uniform_vector(Vector2d(-0.5, -0.5), Vector2d(0.5, 0.5), random);
    moments.add(middle + in.x() * along + in.y() * Vector3d::UnitZ() + off * normal);
  }
  return moments;
}

constexpr double kAngle = radians(3.0);
constexpr double kGate = 0.005;

TEST(MergePlanes, JoinPiecesOfOneWall) {
  const MergedPieces merged = merge_planes(
      {piece({0, 0, 0}, 1.0, 0.0, 500), piece({3, 0.001, 0}, 2.0), piece({0, 2, 0}, 1.0)}, kAngle, kGate);
  EXPECT_EQ(merged.target, (std::vector<std::int32_t>{0, 0, 1}));
  ASSERT_EQ(merged.planes.size(), 2U);
  EXPECT_EQ(merged.planes[0].count, 4500.0);
}

TEST(MergePlanes, AWallMayBulge) {
  // 14 mm out of line, 3 m apart: two pieces of the size of a wall.
  EXPECT_EQ(merge_planes({piece({0, 0, 0}, 1.5), piece({3, 0.014, 0}, 1.5)}, kAngle, kGate).planes.size(),
            1U);
}

TEST(MergePlanes, SmallPiecesOutOfLineStayApart) {
  // The same step between pieces of 0.3 m: a plane turned by a quarter of a degree would fit both.
  EXPECT_EQ(merge_planes({piece({0, 0, 0}, 0.3), piece({3, 0.014, 0}, 0.3)}, kAngle, kGate).planes.size(),
            2U);
}

TEST(MergePlanes, NeighboursTenCentimetresApartOrTurnedStayApart) {
  EXPECT_EQ(merge_planes({piece({0, 0, 0}, 2.0), piece({0, 0.1, 0}, 2.0)}, kAngle, kGate).planes.size(), 2U);
  EXPECT_EQ(merge_planes({piece({0, 0, 0}, 0.1), piece({0, 0, 0}, 0.1, 4.0)}, kAngle, kGate).planes.size(),
            2U);
}

TEST(MergePlanes, PiecesOfFewerThanThreePointsAreDropped) {
  PointMoments two;
  two.add({0, 0, 0});
  two.add({1, 0, 0});
  const MergedPieces merged = merge_planes({PointMoments{}, two, piece({0, 0, 0}, 1.0)}, kAngle, kGate);
  EXPECT_EQ(merged.target, (std::vector<std::int32_t>{-1, -1, 0}));
  EXPECT_TRUE(merge_planes({}, kAngle, kGate).planes.empty());
}

}  // namespace
}  // namespace limen
