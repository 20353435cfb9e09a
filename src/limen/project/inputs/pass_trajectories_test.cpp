// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/inputs/pass_trajectories.h"

#include <gtest/gtest.h>

#include "limen/project/store/kept_notes.h"

namespace limen {
namespace {

std::shared_ptr<const Trajectory> from_to(double first_s, double last_s) {
  const std::vector<double> times_s = {first_s, last_s};
  const std::vector<Vector3d> places = {Vector3d::Zero(), Vector3d::UnitX()};
  return std::make_shared<const Trajectory>(times_s, places, "old/way.csv", 100.0);
}

TEST(PassTrajectories, TheNoteTellsWhichOneByItsNumberNotByItsName) {
  Scan scan;
  scan.name = "pass.las";
  for (int k = 0; k < 5; ++k) {
    scan.points.emplace_back(k, 2.0, 0.0);
    scan.times_s.push_back(100.0 + k);
  }
  std::vector<std::string> notes = {"the scanner position is unknown: the file does not state it"};
  const Scan along = along_trajectory(scan, {from_to(0.0, 10.0), from_to(99.0, 105.0)}, notes);
  EXPECT_EQ(along.size(), scan.size());
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_EQ(notes.front(), "pass.las was measured along " + name_mark(2));
}

}  // namespace
}  // namespace limen
