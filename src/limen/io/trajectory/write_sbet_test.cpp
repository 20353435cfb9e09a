// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/trajectory/write_sbet.h"

#include <cmath>

#include "support/test_support.h"
#include <gtest/gtest.h>

#include "limen/base/angles.h"
#include "limen/io/crs/proj_library.h"
#include "limen/io/trajectory/read_trajectory.h"

namespace limen {
namespace {

/// A car that drives north-east in Strasbourg, leaning and climbing.
std::vector<SbetRecord> drive() {
  std::vector<SbetRecord> records;
  for (int k = 0; k < 50; ++k) {
    SbetRecord record{};
    record[0] = 1000.0 + 0.1 * k;
    record[1] = radians(48.58) + 1.2e-7 * k;
    record[2] = radians(7.75) + 1.5e-7 * k;
    record[3] = 190.0 + 0.01 * k;
    record[7] = 0.02;
    record[8] = -0.03;
    record[9] = radians(50.0) + 0.001 * k;
    record[10] = 0.4;
    records.push_back(record);
  }
  return records;
}

TEST(WriteSbet, WithoutAMotionEverythingStays) {
  if (proj_library() == nullptr) GTEST_SKIP() << "there is no PROJ";
  const MapProjection lambert("EPSG:2154", "");
  const std::vector<SbetRecord> before = drive();
  const std::vector<SbetRecord> after = moved_records(before, lambert, lambert, {});
  ASSERT_EQ(after.size(), before.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    // 1e-11 rad are 0.06 mm on the ground. The north of the map is found between two places 13 m apart, whose
    // coordinates of 7e6 m are rounded to 1e-9 m.
    for (std::size_t k = 0; k < 17; ++k) {
      const double bound = k == 3 ? 1e-6 : k >= 7 && k <= 9 ? 1e-9 : 1e-11;
      EXPECT_NEAR(after[i][k], before[i][k], bound) << k;
    }
  }
}

TEST(WriteSbet, PlacesAndAttitudesMoveWithTheMap) {
  if (proj_library() == nullptr) GTEST_SKIP() << "there is no PROJ";
  const MapProjection utm("EPSG:32632", "");
  const MapProjection lambert("EPSG:2154", "");
  SbetMotion motion;
  motion.frame_from_map.rotation = rotation_exp({0, 0, 0.3});
  const std::vector<SbetRecord> before = drive();
  const Vector3d first = utm.to_map(before[0][1], before[0][2], before[0][3]);
  motion.frame_from_map.translation =
      Vector3d(1050000, 6841000, 150) - motion.frame_from_map.rotation * first;
  // A correction that shifts and turns.
  Vector6d value;
  value << 0.001, 0.0, -0.002, 0.03, -0.02, 0.01;
  const SplineMotion bend({1000.0, 1002.0, 1005.0}, {value, value, value}, {1050000, 6841000, 150});
  motion.bend = &bend;
  const std::vector<SbetRecord> after = moved_records(before, utm, lambert, motion);

  // The same by way of the reader: places with a lever arm know of the attitude.
  const testing_io::TemporaryFolder folder;
  (void)folder.write("before.sbet", sbet_bytes(before));
  (void)folder.write("after.sbet", sbet_bytes(after));
  for (const Vector3d& arm : {Vector3d(0, 0, 0), Vector3d(3, -2, 1)}) {
    TrajectoryOptions old_map;
    old_map.utm_zone = "32N";
    old_map.lever_arm_m = arm;
    TrajectoryOptions new_map = old_map;
    new_map.utm_zone = "EPSG:2154";
    const Trajectory old_way = read_trajectory(folder / "before.sbet", old_map);
    const Trajectory new_way = read_trajectory(folder / "after.sbet", new_map);
    for (std::size_t i = 0; i < before.size(); ++i) {
      const Vector3d expected = bend.moved(motion.frame_from_map * old_way.place(i), before[i][0]);
      EXPECT_LT((new_way.place(i) - expected).norm(), 1e-5) << i;
    }
  }
  EXPECT_EQ(read_sbet_records(folder / "after.sbet"), after);
}

TEST(WriteSbet, OfPlacesAloneTheHeadingIsThatOfTheWay) {
  if (proj_library() == nullptr) GTEST_SKIP() << "there is no PROJ";
  const MapProjection lambert("EPSG:2154", "");
  std::vector<TimedPlace> places;
  for (int k = 0; k < 20; ++k)
    places.push_back({5.0 + k, Vector3d(1050000 + 2.0 * k, 6841000 + 2.0 * k, 150)});
  const std::vector<SbetRecord> records = records_of_places(places, lambert);
  const testing_io::TemporaryFolder folder;
  (void)folder.write("way.sbet", sbet_bytes(records));
  TrajectoryOptions options;
  options.utm_zone = "EPSG:2154";
  options.max_gap_s = 2.0;
  options.lever_arm_m = {1.0, 0.0, 0.0};  // forward
  const Trajectory way = read_trajectory(folder / "way.sbet", options);
  const Vector3d ahead = way.place(7) - places[7].x;
  EXPECT_LT((ahead - Vector3d(std::sqrt(0.5), std::sqrt(0.5), 0)).norm(), 1e-4);
  EXPECT_NEAR(std::hypot(records[7][4], records[7][5]), std::sqrt(8.0), 1e-9);
}

}  // namespace
}  // namespace limen
