// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/trajectory/trajectory.h"

#include <cmath>

#include "support/test_support.h"
#include <gtest/gtest.h>

#include "limen/base/angles.h"
#include "limen/base/error.h"
#include "limen/io/cloud/read_scan.h"
#include "limen/io/trajectory/read_trajectory.h"
#include "limen/io/trajectory/transverse_mercator.h"

namespace limen {
namespace {

using namespace testing_io;

Geodetic place(double latitude_deg, double longitude_deg, double height_m = 0.0) {
  return {radians(latitude_deg), radians(longitude_deg), height_m};
}

/// An SBET record.
std::string sbet(double time, const Geodetic& at, double roll = 0.0, double pitch = 0.0,
                 double heading = 0.0) {
  const double numbers[17] = {time, at.latitude_rad, at.longitude_rad, at.height_m, 0, 0, 0,
                              roll, pitch,           heading};
  std::string bytes;
  for (const double number : numbers) bytes += bytes_of(number);
  return bytes;
}

template <typename Call>
std::string message_of(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(TransverseMercator, AgreesWithPublishedPlaces) {
  // Of the manual of GeographicLib's GeoConvert: 33.3 N 44.4 E.
  EXPECT_EQ(utm_zone_of(place(33.3, 44.4)).number, 38);
  const GridPlace baghdad = to_utm(place(33.3, 44.4, 34.0), {38, false});
  EXPECT_NEAR(baghdad.x.x(), 444140.54, 0.006);
  EXPECT_NEAR(baghdad.x.y(), 3684706.36, 0.006);
  EXPECT_EQ(baghdad.x.z(), 34.0);
  EXPECT_NEAR(to_utm(place(0.0, 3.0), {31, true}).x.y(), 1e7, 1e-9);
}

/// The arc of the meridian from the equator, by Simpson's rule over its radius of curvature.
double meridian_arc_m(double latitude_rad) {
  const double f = 1.0 / 298.257223563;
  const double e2 = f * (2.0 - f);
  const auto radius = [&](double latitude) {
    return 6378137.0 * (1.0 - e2) / std::pow(1.0 - e2 * std::sin(latitude) * std::sin(latitude), 1.5);
  };
  constexpr int kSteps = 2000;
  double sum = 0.0;
  for (int k = 0; k <= kSteps; ++k) {
    const double weight = k == 0 || k == kSteps ? 1.0 : (k % 2 == 1 ? 4.0 : 2.0);
    sum += weight * radius(latitude_rad * k / kSteps);
  }
  return sum * latitude_rad / kSteps / 3.0;
}

TEST(TransverseMercator, TheMeridianIsAsLongAsItIs) {
  for (const double latitude : {1.0, 30.0, 48.58, 75.0}) {
    const GridPlace there = to_utm(place(latitude, 9.0), {32, false});
    EXPECT_NEAR(there.x.x(), 5e5, 1e-6);
    EXPECT_NEAR(there.x.y(), 0.9996 * meridian_arc_m(radians(latitude)), 1e-4);
    EXPECT_NEAR(there.convergence_rad, 0.0, 1e-15);
  }
}

TEST(TransverseMercator, TellsWhereGridNorthPoints) {
  // A short step to the north on the ground, seen in the grid: turned by the convergence, counterclockwise.
  const Geodetic at = place(48.58, 11.9);
  const Vector3d step =
      to_utm({at.latitude_rad + 1e-7, at.longitude_rad, 0.0}, {32, false}).x - to_utm(at, {32, false}).x;
  EXPECT_NEAR(std::atan2(-step.x(), step.y()), to_utm(at, {32, false}).convergence_rad, 1e-7);
  EXPECT_GT(to_utm(at, {32, false}).convergence_rad, 0.03);
}

TEST(TransverseMercator, ReadsZones) {
  EXPECT_EQ(parse_utm_zone("32N")->number, 32);
  EXPECT_TRUE(parse_utm_zone("19S")->south);
  for (const char* wrong : {"", "0", "61", "N32", "32X", "32NN", "3.2"})
    EXPECT_FALSE(parse_utm_zone(wrong)) << wrong;
}

TEST(Trajectory, InterpolatesWithinItsTimesAndNotAcrossGaps) {
  const Trajectory trajectory({2.0, 0.0, 1.0, 10.0, 1.0},
                              {{2, 0, 0}, {0, 0, 0}, {1, 0, 0}, {10, 0, 0}, {1, 0, 0}}, "t");
  EXPECT_EQ(trajectory.size(), 4U);
  EXPECT_EQ(*trajectory.position(0.25), Vector3d(0.25, 0, 0));
  EXPECT_EQ(*trajectory.position(2.0), Vector3d(2, 0, 0));
  EXPECT_EQ(*trajectory.position(10.0), Vector3d(10, 0, 0));
  for (const double unknown : {-0.1, 10.1, 5.0, std::nan("")})
    EXPECT_FALSE(trajectory.position(unknown)) << unknown;
}

TEST(Trajectory, RefusesWhatIsNone) {
  EXPECT_THROW(Trajectory({1.0}, {{0, 0, 0}}, "t"), Error);
  EXPECT_THROW(Trajectory({1.0, 1.0}, {{0, 0, 0}, {1, 0, 0}}, "t"), Error);
  EXPECT_THROW(Trajectory({1.0, std::nan("")}, {{0, 0, 0}, {1, 0, 0}}, "t"), Error);
}

TEST(ReadTrajectory, TextByHeaderAndByNames) {
  const TemporaryFolder folder;
  const auto by_header = folder.write("a.csv", "# Time[s], Easting, Northing, H\n1,10,20,30\n2,11,20,30\n");
  EXPECT_EQ(*read_trajectory(by_header).position(1.5), Vector3d(10.5, 20, 30));
  TrajectoryOptions options;
  options.columns = {"z", "y", "x", "skip", "time"};
  options.time_offset_s = 100.0;
  const auto by_name = folder.write("b.txt", "30 20 10 9 1\n30 20 11 9 2\n");
  EXPECT_EQ(*read_trajectory(by_name, options).position(101.5), Vector3d(10.5, 20, 30));
  EXPECT_NE(message_of([&] { read_trajectory(by_name); }).find("have no names"), std::string::npos);
}

TEST(ReadTrajectory, SbetIsProjected) {
  const TemporaryFolder folder;
  const auto file =
      folder.write("a.sbet", sbet(1.0, place(48.58, 7.76, 150)) + sbet(1.5, place(48.5801, 7.76, 151)));
  const Trajectory grid = read_trajectory(file);
  EXPECT_EQ(*grid.position(1.0), to_utm(place(48.58, 7.76, 150), {32, false}).x);
  TrajectoryOptions local;
  local.utm_zone = "local";
  const Vector3d step = *read_trajectory(file, local).position(1.5);
  EXPECT_NEAR(step.x(), 0.0, 1e-6);
  EXPECT_NEAR(step.y(), 11.12, 0.01);
  EXPECT_NEAR(step.z(), 1.0, 1e-3);
}

TEST(ReadTrajectory, TheLeverArmTurnsWithTheBody) {
  const TemporaryFolder folder;
  TrajectoryOptions options;
  options.utm_zone = "local";
  options.lever_arm_m = {2.0, 1.0, 0.5};  // forward, right, down
  const Geodetic at = place(48.58, 7.76, 150);
  // Heading east: forward is east, right is south.
  const auto east = folder.write("e.sbet", sbet(1, at, 0, 0, radians(90)) + sbet(2, at, 0, 0, radians(90)));
  EXPECT_LT((*read_trajectory(east, options).position(1) - Vector3d(2.0, -1.0, -0.5)).norm(), 1e-9);
  // Nose up by 90 degrees, heading north: forward is up, down is north.
  const auto up = folder.write("u.sbet", sbet(1, at, 0, radians(90), 0) + sbet(2, at, 0, radians(90), 0));
  EXPECT_LT((*read_trajectory(up, options).position(1) - Vector3d(1.0, 0.5, 2.0)).norm(), 1e-9);
  const auto text = folder.write("t.csv", "time,x,y,z\n1,0,0,0\n2,0,0,0\n");
  EXPECT_NE(message_of([&] { read_trajectory(text, options); }).find("no attitude"), std::string::npos);
}

TEST(ReadTrajectory, DamagedFilesAreNamed) {
  const TemporaryFolder folder;
  const std::string good = sbet(1.0, place(48, 7)) + sbet(2.0, place(48, 7));
  const auto cut = folder.write("cut.sbet", good.substr(0, 271));
  EXPECT_NE(message_of([&] { read_trajectory(cut); }).find("271 bytes"), std::string::npos);
  const auto wild = folder.write("wild.sbet", good + sbet(3.0, place(4800, 7)));
  EXPECT_NE(message_of([&] { read_trajectory(wild); }).find("byte 272"), std::string::npos);
}

Scan timed_scan(double first_s) {
  Scan scan;
  scan.name = "scan";
  scan.local_origin = {100.0, 0.0, 0.0};
  for (int k = 0; k < 5; ++k) {
    scan.points.emplace_back(k, 3.0, 1.0);
    scan.times_s.push_back(first_s + k);
  }
  return scan;
}

TEST(WithTrajectory, GivesEachPointItsCentre) {
  const Trajectory trajectory({0.5, 1.5, 2.5, 3.5}, {{101, 0, 0}, {102, 0, 0}, {103, 0, 0}, {104, 0, 0}},
                              "t");
  const FollowedScan followed = with_trajectory(timed_scan(0.0), trajectory);
  EXPECT_EQ(followed.left_out, 2U);
  ASSERT_EQ(followed.scan.size(), 3U);
  EXPECT_EQ(followed.scan.points[0], Vector3d(1, 3, 1));
  EXPECT_EQ(followed.scan.centres[0], Vector3d(1.5, 0, 0));
}

TEST(WithTrajectory, TellsHowTimesCouldMeet) {
  const double scan_start = 2200.0 * 604800.0 + 1000.0 - 1e9;  // adjusted standard time in week 2200
  const Trajectory trajectory({900.0, 2000.0}, {{0, 0, 0}, {1, 0, 0}}, "drive", 1e9);
  const std::string message = message_of([&] { with_trajectory(timed_scan(scan_start), trajectory); });
  EXPECT_NE(message.find("900.000 to 2000.000 s"), std::string::npos) << message;
  EXPECT_NE(message.find("changed by +330560000 s they would overlap"), std::string::npos) << message;
  Scan timeless = timed_scan(0.0);
  timeless.times_s.clear();
  EXPECT_NE(message_of([&] { with_trajectory(timeless, trajectory); }).find("no times"), std::string::npos);
}

TEST(WithTrajectory, RefusesAnotherFrame) {
  const Trajectory trajectory({0.0, 10.0}, {{5e5, 5.4e6, 0}, {5e5, 5.4e6, 0}}, "drive", 100.0);
  EXPECT_NE(message_of([&] { with_trajectory(timed_scan(1.0), trajectory); }).find("km away from the points"),
            std::string::npos);
}

TEST(CoveringTrajectory, OfAnotherDriveIsNotTaken) {
  const auto drive = [](double y) {
    return std::make_shared<const Trajectory>(std::vector<double>{0.0, 10.0},
                                              std::vector<Vector3d>{{0, y, 2}, {10, y, 2}}, "drive", 100.0);
  };
  Scan pass = timed_scan(1.0);
  EXPECT_NE(covering_trajectory(pass, {drive(5.0)}), nullptr);
  // Its own scanner positions say along which way it was measured.
  for (const double time_s : pass.times_s) pass.centres.emplace_back(time_s - 100.0, 0.1, 2.0);
  EXPECT_EQ(covering_trajectory(pass, {drive(5.0)}), nullptr);
  const auto own = drive(0.0);
  EXPECT_EQ(covering_trajectory(pass, {drive(5.0), own}), own.get());
}

TEST(WithTrajectory, IsUsedWhereAScanIsRead) {
  const TemporaryFolder folder;
  const auto scan = folder.write("s.csv", "x,y,z,gps_time\n1,2,3,10\n2,2,3,11\n3,2,3,99\n");
  ReadOptions options;
  options.trajectory = std::make_shared<const Trajectory>(
      std::vector<double>{10.0, 11.0}, std::vector<Vector3d>{{0, 0, 1}, {1, 0, 1}}, "drive");
  const ScanFile file = read_scan_file(scan, options);
  ASSERT_EQ(file.scans[0].size(), 2U);
  EXPECT_EQ(file.scans[0].centres[1], Vector3d(1, 0, 1));
  EXPECT_EQ(file.dropped, 1U);
}

}  // namespace
}  // namespace limen
