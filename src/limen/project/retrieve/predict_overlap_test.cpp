// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "support/drawn_rooms.h"
#include <gtest/gtest.h>

#include "limen/project/retrieve/choose_pairs.h"

namespace limen {
namespace {

/// A room of 4 x 3 m, seen from within.
ScanDigest room() {
  return drawn_room(Vector3d::Zero(), 4.0, 3.0);
}

TEST(PredictOverlap, TwoScansOfOneRoomShareItsSurface) {
  EXPECT_NEAR(predicted_overlap(room(), room(), turn_and_shift(0.0, {0, 0, 0})), 25.0,
              1e-9);  // each 5 m^2 at most
}

TEST(PredictOverlap, TheRoomNextDoorSharesNothing) {
  EXPECT_LT(predicted_overlap(room(), room(), turn_and_shift(0.0, {4.2, 0, 0})), 2.0);  // but the walls go on
  EXPECT_LT(predicted_overlap(room(), room(), turn_and_shift(0.0, {9.0, 7.0, 0})), 1e-6);
}

TEST(PredictOverlap, BothSidesOfAWallAreTwo) {
  ScanDigest here;
  here.planes = {rectangle({0, 0, 0}, Vector3d::UnitX(), 4.0, 2.5)};
  ScanDigest there;
  there.planes = {rectangle({0.1, 0, 0}, -Vector3d::UnitX(), 4.0, 2.5)};
  EXPECT_EQ(predicted_overlap(here, there, {}), 0.0);
}

TEST(PredictOverlap, IsTheSameBothWaysAndInEveryFrame) {
  const Rigid3 between = turn_and_shift(0.7, {1.0, 0.3, 0.05});
  const double there = predicted_overlap(room(), room(), between);
  EXPECT_NEAR(predicted_overlap(room(), room(), inverse(between)), there, 0.05 * there + 1e-9);
  // The second scan in other axes: the pose between the two follows.
  const Rigid3 turned = turn_and_shift(-1.1, {0, 0, 0});
  ScanDigest other = room();
  for (PlaneDigest& plane : other.planes) {
    plane.plane.normal = turned.rotation * plane.plane.normal;
    plane.centroid = turned * plane.centroid;
    plane.moments.sum = turned.rotation * plane.moments.sum;
    plane.moments.outer = turned.rotation * plane.moments.outer * turned.rotation.transpose();
  }
  EXPECT_NEAR(predicted_overlap(room(), other, turned * between), there, 1e-9);
}

TEST(PredictOverlap, AllPlanesLieInTheirBox) {
  const Rigid3 place = turn_and_shift(0.4, {100.0, -20.0, 3.0});
  const Eigen::AlignedBox3d box = box_of_planes(room(), place);
  for (const double x : {-1.9, 1.9})
    for (const double y : {-1.4, 1.4}) EXPECT_TRUE(box.contains(place * Vector3d(x, y, 0.0)));
  EXPECT_LT(box.sizes().maxCoeff(), 7.0);
  EXPECT_TRUE(box_of_planes({}, place).isEmpty());
}

}  // namespace
}  // namespace limen
