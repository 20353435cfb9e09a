// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/cloud/point_print.h"

#include <algorithm>

#include "support/synthetic_room.h"
#include <gtest/gtest.h>

#include "limen/geometry/rigid.h"

namespace limen {
namespace {

TEST(PointPrint, ACopyIsKnownInAnyOrderAfterAnyMotionAndRounded) {
  const Scan scan = box_scan(20000, -1.0, 1.0);
  Scan copy = scan;
  std::reverse(copy.points.begin(), copy.points.end());
  copy.local_origin = {100.0, -200.0, 0.0};
  const Matrix3d turn = rotation_exp(Vector3d(0.3, -1.0, 2.0));
  for (Vector3d& point : copy.points)
    point = (1000.0 * (turn * point - copy.local_origin)).array().round().matrix() / 1000.0;
  EXPECT_TRUE(same_points(print_of(scan), print_of(copy)));
}

TEST(PointPrint, AnotherScanOfTheSameRoomIsNoCopy) {
  const Scan scan = box_scan(20000, -1.0, 1.0);
  Scan other = scan;
  // A second visit: as many points in the same room, each with noise of its own.
  RandomStream stream(7);
  for (Vector3d& point : other.points) point *= 1.0 + 0.001 * stream.normal();
  EXPECT_FALSE(same_points(print_of(scan), print_of(other)));
  Scan fewer = scan;
  fewer.points.pop_back();
  EXPECT_FALSE(same_points(print_of(scan), print_of(fewer)));
  EXPECT_FALSE(same_points(print_of(Scan{}), print_of(Scan{})));
}

TEST(PointPrint, ASecondScanFromTheSameTripodIsNoCopy) {
  const Scan scan = box_scan(20000, -1.0, 1.0);
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Scan other = scan;
    RandomStream stream(seed);
    for (Vector3d& point : other.points) point += 0.0005 * stream.normal() * point.normalized();
    EXPECT_FALSE(same_points(print_of(scan), print_of(other))) << seed;
  }
}

TEST(PointPrint, APartIsKnownByItsMarks) {
  const Scan scan = box_scan(20000, -1.0, 1.0);
  RandomStream stream(8);
  for (const std::uint32_t one_of : {2U, 10U, 60U}) {
    Scan part;
    part.local_origin = {50.0, 0.0, 7.0};
    for (const Vector3d& point : scan.points) {
      if (stream.below(one_of) == 0) part.points.push_back(scan.local_origin + point - part.local_origin);
    }
    EXPECT_TRUE(is_part_of(print_of(part), print_of(scan))) << one_of;
    EXPECT_FALSE(is_part_of(print_of(scan), print_of(part))) << one_of;
  }
  Scan other = scan;
  for (Vector3d& point : other.points) point *= 1.0 + 0.001 * stream.normal();
  EXPECT_FALSE(is_part_of(print_of(other), print_of(scan)));
  EXPECT_FALSE(is_part_of(print_of(Scan{}), print_of(scan)));
}

}  // namespace
}  // namespace limen
