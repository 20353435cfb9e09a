// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/cloud/point_sample.h"

#include <algorithm>

#include "support/synthetic_room.h"
#include <gtest/gtest.h>

namespace limen {
namespace {

TEST(PointSample, ACopyIsKnownInAnyOrderAboutAnyOriginAndRounded) {
  const Scan scan = box_scan(20000, -1.0, 1.0);
  const PointSample sample(scan);
  EXPECT_TRUE(sample.is_of(scan));
  Scan copy = scan;
  std::reverse(copy.points.begin(), copy.points.end());
  copy.local_origin = {100.0, -200.0, 0.0};
  for (Vector3d& point : copy.points)
    point = (1000.0 * (point - copy.local_origin)).array().round().matrix() / 1000.0;
  EXPECT_TRUE(sample.is_of(copy));
}

TEST(PointSample, AnotherScanOfTheSameRoomIsNoCopy) {
  const Scan scan = box_scan(20000, -1.0, 1.0);
  Scan other = scan;
  // A second visit: as many points in the same room, each with noise of its own.
  RandomStream stream(7);
  for (Vector3d& point : other.points) point *= 1.0 + 0.001 * stream.normal();
  EXPECT_FALSE(PointSample(scan).is_of(other));
  Scan fewer = scan;
  fewer.points.pop_back();
  EXPECT_FALSE(PointSample(scan).is_of(fewer));
  EXPECT_FALSE(PointSample(Scan{}).is_of(Scan{}));
}

TEST(PointSample, APartIsKnownByItsMarks) {
  const Scan scan = box_scan(20000, -1.0, 1.0);
  RandomStream stream(8);
  for (const std::uint32_t one_of : {2U, 10U, 60U}) {
    Scan part;
    part.local_origin = {50.0, 0.0, 7.0};
    for (const Vector3d& point : scan.points) {
      if (stream.below(one_of) == 0) part.points.push_back(scan.local_origin + point - part.local_origin);
    }
    EXPECT_TRUE(is_part_of(point_marks(part), point_marks(scan))) << one_of;
    EXPECT_FALSE(is_part_of(point_marks(scan), point_marks(part))) << one_of;
  }
  Scan other = scan;
  for (Vector3d& point : other.points) point *= 1.0 + 0.001 * stream.normal();
  EXPECT_FALSE(is_part_of(point_marks(other), point_marks(scan)));
  EXPECT_FALSE(is_part_of(point_marks(Scan{}), point_marks(scan)));
}

}  // namespace
}  // namespace limen
