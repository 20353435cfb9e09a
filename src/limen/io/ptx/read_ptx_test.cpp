// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "support/test_support.h"
#include <gtest/gtest.h>

#include "limen/base/error.h"
#include "limen/io/cloud/read_scan.h"
#include "limen/io/ptx/ptx.h"

namespace limen {
namespace {

using namespace testing_io;

/// A header with the pose written to `digits` decimals.
std::string header(int columns, int rows, const Rigid3& pose, int digits) {
  std::string text = fmt::format("{}\n{}\n", columns, rows);
  const auto line = [&](const Vector3d& x, const char* last) {
    text += fmt::format("{:.{}f} {:.{}f} {:.{}f}{}\n", x.x(), digits, x.y(), digits, x.z(), digits, last);
  };
  line(pose.translation, "");
  for (int k = 0; k < 3; ++k) line(pose.rotation.col(k), "");
  for (int k = 0; k < 3; ++k) line(pose.rotation.col(k), " 0");
  line(pose.translation, " 1");
  return text;
}

Rigid3 pose_a() {
  return {rotation_exp({0.02, -0.01, 1.1}), {1050000.1234, 6840000.5678, 142.25}};
}
Rigid3 pose_b() {
  return {rotation_exp({0.0, 0.01, -2.0}), {1050009.5, 6840003.25, 142.5}};
}

/// 3 columns of 4 points; every third return is missing.
std::string station(const Rigid3& pose, int digits) {
  std::string text = header(3, 4, pose, digits);
  for (int i = 0; i < 12; ++i) {
    text += i % 3 == 2 ? "0 0 0 0.5 0 0 0\n"
                       : fmt::format("{} {} {} 0.25 10 20 {}\n", 1.5 + i, -2.0, 0.125 * i, i);
  }
  return text;
}

TEST(ReadPtx, BringsEveryStationToTheWorld) {
  const ScanFile file = read_ptx(station(pose_a(), 12) + station(pose_b(), 12), "two.ptx");
  ASSERT_EQ(file.scans.size(), 2U);
  EXPECT_EQ(file.dropped, 8U);
  for (const std::size_t s : {0U, 1U}) {
    const Scan& scan = file.scans[s];
    const Rigid3 pose = s == 0 ? pose_a() : pose_b();
    scan.check();
    ASSERT_EQ(scan.size(), 8U);
    ASSERT_EQ(scan.centres.size(), 1U);
    EXPECT_LT((scan.local_origin + scan.centres[0] - pose.translation).norm(), 1e-8);
    // Point 3 of the file's twelve is number 2 of those that are there.
    EXPECT_LT((scan.local_origin + scan.points[2] - pose * Vector3d(4.5, -2.0, 0.375)).norm(), 1e-8);
    EXPECT_EQ(scan.topology.line[2], 0);
    EXPECT_EQ(scan.topology.index[2], 3);
    EXPECT_EQ(scan.topology.line[3], 1);
    EXPECT_EQ(scan.topology.index[3], 0);
    EXPECT_EQ(scan.colours[2 * 3 + 2], 3);
    EXPECT_EQ(scan.intensities[2], 0.25F);
  }
  EXPECT_NE(file.scans[0].name, file.scans[1].name);
}

TEST(ReadPtx, AMatrixOfSixDigitsStaysRigid) {
  const Scan scan = read_ptx(station(pose_a(), 6), "six.ptx").scans.at(0);
  const double before = (Vector3d(1.5, -2.0, 0.0) - Vector3d(11.5, -2.0, 1.25)).norm();
  EXPECT_NEAR((scan.points[0] - scan.points[7]).norm() - before, 0.0, 0.5e-8);
}

TEST(ReadPtx, JoinsStationsWithTheirCentres) {
  const ScanFile file = read_ptx(station(pose_a(), 12) + station(pose_b(), 12), "two.ptx");
  const Scan joined = join_scans(file.scans);
  joined.check();
  ASSERT_EQ(joined.size(), 16U);
  ASSERT_TRUE(joined.mobile());
  for (const std::size_t i : {0U, 7U, 8U, 15U}) {
    const Scan& scan = file.scans[i / 8];
    EXPECT_LT((joined.points[i] + joined.local_origin - scan.points[i % 8] - scan.local_origin).norm(), 1e-9);
    EXPECT_LT((joined.centre(i) + joined.local_origin - scan.centres[0] - scan.local_origin).norm(), 1e-9);
  }
  EXPECT_GT(joined.topology.line[8], joined.topology.line[7] + 1)
      << "columns of two stations are no neighbours";
}

TEST(ReadPtx, AStationWithoutReturnsIsPassedOver) {
  std::string empty = header(1, 2, pose_a(), 9) + "0 0 0 0.5\n0 0 0 0.5\n";
  EXPECT_EQ(read_ptx(empty + station(pose_b(), 9), "e.ptx").scans.size(), 1U);
  EXPECT_THROW(read_ptx(empty, "e.ptx"), Error);
}

}  // namespace
}  // namespace limen
