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

}  // namespace
}  // namespace limen
