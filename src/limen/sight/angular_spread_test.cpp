// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/sight/angular_spread.h"

#include "support/synthetic_room.h"
#include <gtest/gtest.h>

#include "limen/base/angles.h"

namespace limen {
namespace {

std::vector<Vector3d> room() {
  return box_scan(20000, radians(-60.0), radians(60.0)).points;
}

TEST(AngularSpread, FromTheScannerNothingIsHiddenAndNoPlaceFitsBetter) {
  const std::vector<Vector3d> points = room();
  const std::size_t cells = direction_cells(points, Vector3d::Zero());
  EXPECT_LT(angular_spread(points, Vector3d::Zero(), cells).hidden, 0.01);
  EXPECT_LT(better_place_nearby(points, Vector3d::Zero()), 0.03);
}

TEST(AngularSpread, OtherPlacesSeeThePointsLessEvenly) {
  const std::vector<Vector3d> points = room();
  for (const Vector3d& off :
       {Vector3d(2, 0.5, 0.4), Vector3d(-1, -2, 1), Vector3d(0, 6, 0), Vector3d(2, 0, 4)})
    EXPECT_GT(better_place_nearby(points, off), 0.05) << off.transpose();
}

TEST(AngularSpread, WhatLiesBehindOtherPointsIsHidden) {
  std::vector<Vector3d> points = room();
  const std::size_t front = points.size() / 2;
  for (std::size_t i = 0; i < front; ++i) points[i] *= 2.0;
  const AngularSpread spread =
      angular_spread(points, Vector3d::Zero(), direction_cells(points, Vector3d::Zero()));
  EXPECT_NEAR(spread.hidden, 0.5, 0.1);
}

TEST(AngularSpread, OfNoPointsIsNothing) {
  EXPECT_EQ(angular_spread({}, Vector3d::Zero(), 8).divergence, 0.0);
  EXPECT_EQ(better_place_nearby({}, Vector3d::Zero()), 0.0);
}

}  // namespace
}  // namespace limen
