// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/cloud/corrected_trajectory.h"

#include <memory>

#include "support/test_support.h"
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "limen/base/error.h"
#include "limen/io/cloud/read_scan.h"
#include "limen/io/trajectory/read_trajectory.h"

namespace limen {
namespace {

using namespace testing_io;

/// A drive along x, one point each tenth of a second, seen from 5 m beside it.
std::string drive_text(const char* time_name) {
  std::string text = fmt::format("x,y,z,x_origin,y_origin,z_origin,{}\n", time_name);
  for (int k = 0; k < 100; ++k)
    text += fmt::format("{},5,1,{},0,2,{}\n", 0.5 * k, 0.5 * k, 381000.0 + 0.1 * k);
  return text;
}

/// A quarter turn about z and a shift, then a drift.
StationToMove drifting(const std::filesystem::path& path) {
  StationToMove pass;
  pass.path = path;
  pass.target_from_source.rotation = rotation_exp({0, 0, 0.5 * M_PI});
  pass.target_from_source.translation = {652300.0, 6862100.0, 30.0};
  std::vector<double> times;
  std::vector<Vector6d> values;
  for (int k = 0; k < 5; ++k) {
    times.push_back(381000.0 + 2.4 * k);
    Vector6d value = Vector6d::Zero();
    value.tail<3>() = Vector3d(0.01 * k, -0.02, 0.003 * k * k);
    value.z() = 1e-3 * k;
    values.push_back(value);
  }
  pass.bend = std::make_shared<const SplineMotion>(times, values, Vector3d(652300.0, 6862120.0, 30.0));
  return pass;
}

TEST(CorrectedTrajectory, EachPointMovesByTheDriftOfItsOwnTime) {
  const TemporaryFolder folder;
  const StationToMove pass = drifting(folder.write("drive.csv", drive_text("gps_time")));
  for (const char* name : {"moved.ply", "moved.las", "moved.e57"}) {
    move_stations({pass}, folder / name);
    const Scan before = read_scan(folder / "drive.csv");
    const Scan after = read_scan(folder / name);
    ASSERT_EQ(after.size(), before.size()) << name;
    for (std::size_t i = 0; i < before.size(); i += 7) {
      const double time = before.times_s[i];
      EXPECT_NEAR(after.times_s[i], time, 1e-6);
      const Vector3d expected =
          pass.bend->moved(pass.target_from_source * (before.local_origin + before.points[i]), time);
      EXPECT_LT((after.local_origin + after.points[i] - expected).norm(), 2e-3) << name;
    }
  }
  const Scan before = read_scan(folder / "drive.csv");
  const Scan after = read_scan(folder / "moved.ply");
  ASSERT_EQ(after.centres.size(), before.centres.size());
  for (std::size_t i = 0; i < before.size(); i += 7) {
    const Vector3d given = pass.target_from_source * (before.local_origin + before.centres[i]);
    const Vector3d expected = pass.bend->moved(given, before.times_s[i]);
    EXPECT_LT((after.local_origin + after.centres[i] - expected).norm(), 1e-6);
    EXPECT_GT((expected - given).norm(), 0.01);
  }
}

TEST(CorrectedTrajectory, IsReadAsATrajectory) {
  const TemporaryFolder folder;
  const StationToMove pass = drifting(folder.write("drive.csv", drive_text("time")));
  const Trajectory way = read_trajectory(folder.write("way.csv", text_of_places(corrected_places(pass))));
  EXPECT_EQ(way.size(), 100U);
  const Vector3d expected = pass.bend->moved(pass.target_from_source * Vector3d(20.0, 0.0, 2.0), 381004.0);
  EXPECT_LT((*way.position(381004.0) - expected).norm(), 2e-5);
}

TEST(CorrectedTrajectory, WithoutTimesThereIsNone) {
  const TemporaryFolder folder;
  const StationToMove pass = drifting(folder.write("drive.csv", drive_text("number")));
  EXPECT_THROW(move_stations({pass}, folder / "moved.ply"), Error);
  EXPECT_FALSE(std::filesystem::exists(folder / "moved.ply"));
}

}  // namespace
}  // namespace limen
