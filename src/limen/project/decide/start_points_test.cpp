// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/decide/start_points.h"

#include <gtest/gtest.h>

#include "limen/base/error.h"

namespace limen {
namespace {

/// Four corners of a room, clicked in both scans: the second time each is missed by what is added.
std::vector<ShownPoint> clicked(const Rigid3& target_from_source, const std::vector<Vector3d>& corners,
                                const std::vector<Vector3d>& misses = {}) {
  std::vector<ShownPoint> points;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Vector3d to =
        target_from_source * corners[k] + (k < misses.size() ? misses[k] : Vector3d(Vector3d::Zero()));
    points.push_back({corners[k].x(), corners[k].y(), corners[k].z(), to.x(), to.y(), to.z()});
  }
  return points;
}

const std::vector<Vector3d> kCorners = {{652000, 6862000, 31}, {652006, 6862000, 31}, {652006, 6862004, 33}};

std::string fault_of(const std::vector<ShownPoint>& points) {
  try {
    static_cast<void>(start_from_points(points));
  } catch (const Error& error) {
    return error.problem();
  }
  return {};
}

TEST(StartPoints, GiveThePoseOfLevelScansAndOfAnyOthers) {
  for (const double tilt : {0.0, 1.2}) {
    const Rigid3 truth{rotation_exp({tilt, 0, 0}) * rotation_exp({0, 0, 2.5}), {-652000, -6861000, 4}};
    const StartPrior start = start_from_points(clicked(truth, kCorners));
    EXPECT_LT(rotation_angle(start.target_from_source.rotation.transpose() * truth.rotation), 1e-6);
    EXPECT_LT((start.target_from_source * kCorners[1] - truth * kCorners[1]).norm(), 1e-5);
  }
}

TEST(StartPoints, AWallClickedAtAnotherHeightTiltsNothing) {
  const Rigid3 truth{rotation_exp({0, 0, -1.0}), {3, 5, 0.2}};
  const Rigid3 found =
      start_from_points(clicked(truth, kCorners, {{0.1, 0, 1.0}, {0, -0.1, -0.5}})).target_from_source;
  EXPECT_DOUBLE_EQ(found.rotation(2, 2), 1.0);
  EXPECT_LT(rotation_angle(found.rotation.transpose() * truth.rotation), 0.05);
}

TEST(StartPoints, WhatGivesNoPoseIsSaidInOneSentence) {
  const Rigid3 same;
  std::vector<Vector3d> corners = kCorners;
  EXPECT_EQ(fault_of(clicked(same, {corners[0], corners[1]})), "2 points are given");
  corners[2] = corners[1] + Vector3d(0.01, 0, 0);
  EXPECT_EQ(fault_of(clicked(same, corners)), "points 2 and 3 are the same place of the moving scan");
  corners[2] = 2.0 * corners[1] - corners[0];
  EXPECT_EQ(fault_of(clicked(same, corners)), "the points of the moving scan lie nearly in a line");
  EXPECT_EQ(fault_of(clicked(same, kCorners, {{0, 0, 0}, {0, -5, 0}})).substr(0, 36),
            "no pose brings the points together: ");
}

TEST(StartPoints, AreWrittenAsTheyAreRead) {
  EXPECT_EQ(words_of(shown_point("-1.25,3,0.5=10,-7.125,1e-3")), "-1.25,3,0.5=10,-7.125,0.001");
  for (const char* bad :
       {"", "1,2,3", "1,2,3,4,5,6", "1,2,3=4,5", "1,2,3=4,5,6,7", "1,2,3=4,5,nan", "1,2=3,4,5,6"})
    EXPECT_THROW(static_cast<void>(shown_point(bad)), Error) << bad;
}

}  // namespace
}  // namespace limen
