// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <limits>

#include "support/test_support.h"
#include <gtest/gtest.h>

#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/io/ply/ply.h"

namespace limen {
namespace {

using namespace testing_io;

constexpr Writing kWritings[] = {Writing::ascii, Writing::little, Writing::big};

Scan read_one(const std::string& bytes, const ReadOptions& options = {}) {
  ScanFile file = read_ply(bytes, "test.ply", options);
  EXPECT_EQ(file.scans.size(), 1U);
  file.scans.front().check();
  return file.scans.front();
}

Vector3d world(const Scan& scan, std::size_t i) {
  return scan.local_origin + scan.points[i];
}

TEST(ReadPly, DoublesOnTheNationalGridKeepMicrometres) {
  const auto points = random_points(70000, {1050000.1234, 6840000.5678, 142.0}, 50.0, 1);
  for (const Writing writing : kWritings) {
    const Scan scan = read_one(simple_ply<double>(points, writing));
    ASSERT_EQ(scan.size(), points.size());
    EXPECT_LT((scan.local_origin - points[0]).cwiseAbs().maxCoeff(), 50.0 + 1e-6);
    EXPECT_TRUE(
        (scan.local_origin / 100.0).array().isApprox((scan.local_origin / 100.0).array().round(), 0.0));
    for (std::size_t i = 0; i < points.size(); ++i) {
      // The subtraction of a near round number is exact: the local coordinate is the true difference.
      ASSERT_EQ(scan.points[i], points[i] - scan.local_origin);
      ASSERT_LT((world(scan, i) - points[i]).norm(), 1e-9);
    }
  }
}

TEST(ReadPly, FloatsAboutAnOffsetLoseNothing) {
  const auto points = random_points(5000, {-20.0, -20.0, 0.0}, 40.0, 2);
  for (const char* comment :
       {"comment offset 1050000.25 6840000.5 100\n", "comment offset Pos 1050000.250 6840000.500 100.0\n",
        "comment pivot 1.05000025e+06 6.8400005e+06 100\n", "obj_info shift: 1050000.25, 6840000.5, 100\n"}) {
    for (const Writing writing : kWritings) {
      const Scan scan = read_one(simple_ply<float>(points, writing, comment));
      const Vector3d offset{1050000.25, 6840000.5, 100.0};
      const Vector3d shift = offset - scan.local_origin;
      const double tolerance = writing == Writing::ascii ? 4e-6 : 1e-13;  // the text rounds the float
      EXPECT_FALSE(scan.centre_known()) << "0 0 0 of a shifted file is no scanner";
      for (std::size_t i = 0; i < points.size(); ++i)
        ASSERT_LT((scan.points[i] - points[i].cast<float>().cast<double>() - shift).norm(), tolerance);
    }
  }
}

TEST(ReadPly, CommentsThatOnlyMentionAnOffsetAreNoOffset) {
  const auto points = room_points(500, 3);
  const Scan scan = read_one(
      simple_ply<double>(points, Writing::little, "comment the offset is 1 2 3\ncomment offset unknown\n"));
  EXPECT_EQ(scan.points[7], points[7]);
}

/// Every number type, other elements on both sides, lists in the points' records.
std::string crowded_ply(Writing w) {
  std::string ply =
      format_line(w) +
      "element face 2\nproperty list uint8 int32 vertex_indices\n"
      "element nothing 5\n"
      "element vertex 3\nproperty short X\nproperty uint8 flag\nproperty list ushort float32 wave\n"
      "element tail 1\nproperty double t\nend_header\n";
  const std::size_t at = ply.find("property list ushort");
  // Text cannot be read behind a list, so there the coordinates stand before it.
  ply.insert(at, "property int y\nproperty float64 z\n");
  for (const int corners : {3, 4}) {
    ply += number(static_cast<std::uint8_t>(corners), w);
    for (int k = 0; k < corners; ++k) ply += number(std::int32_t{k}, w);
    ply += row_end(w);
  }
  for (int i = 0; i < 3; ++i) {
    ply += number(static_cast<std::int16_t>(-300 + i), w) + number(static_cast<std::uint8_t>(i), w);
    ply +=
        number(std::int32_t{4000 + i}, w) + number(0.125 * i, w) + number(static_cast<std::uint16_t>(i), w);
    for (int k = 0; k < i; ++k) ply += number(1.5F, w);
    ply += row_end(w);
  }
  return ply + number(9.0, w) + row_end(w);
}

TEST(ReadPly, ReadsMixedTypesAndPassesOverListsAndOtherElements) {
  for (const Writing writing : kWritings) {
    const Scan scan = read_one(crowded_ply(writing));
    ASSERT_EQ(scan.size(), 3U);
    for (int i = 0; i < 3; ++i)
      EXPECT_EQ(scan.points[static_cast<std::size_t>(i)], Vector3d(-300 + i, 4000 + i, 0.125 * i));
  }
}

std::string attributed_ply(Writing w, int rows, bool same_centre) {
  std::string ply = format_line(w) + fmt::format("element vertex {}\n", rows);
  for (const char* name : {"x", "y", "z", "x_origin", "y_origin", "z_origin", "GPS_time"})
    ply += fmt::format("property double {}\n", name);
  ply += "property int scan_line\nproperty int scan_index\nproperty float reflectance\n";
  ply += "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n";
  for (int i = 0; i < rows; ++i) {
    for (const double x : {1050000.0 + i, 6840000.0, 100.0 + i}) ply += number(x, w);
    for (const double x : {1050000.5 + (same_centre ? 0 : i), 6839990.0, 102.0}) ply += number(x, w);
    ply += number(54160.25 + 1e-6 * i, w) + number(std::int32_t{i / 10}, w) + number(std::int32_t{i % 10}, w);
    ply += number(0.5F * static_cast<float>(i), w);
    for (const int c : {i, 2 * i, 255 - i}) ply += number(static_cast<std::uint8_t>(c), w);
    ply += row_end(w);
  }
  return ply;
}

TEST(ReadPly, ReadsCentresTimesTopologyAndColours) {
  for (const Writing writing : kWritings) {
    const Scan scan = read_one(attributed_ply(writing, 100, false));
    ASSERT_TRUE(scan.mobile());
    for (std::size_t i = 0; i < 100; ++i) {
      const auto n = static_cast<int>(i);
      EXPECT_EQ(scan.centre(i) + scan.local_origin, Vector3d(1050000.5 + n, 6839990.0, 102.0));
      EXPECT_EQ(scan.times_s[i], 54160.25 + 1e-6 * n);
      EXPECT_EQ(scan.topology.line[i], n / 10);
      EXPECT_EQ(scan.topology.index[i], n % 10);
      EXPECT_EQ(scan.intensities[i], 0.5F * static_cast<float>(n));
      EXPECT_EQ(scan.colours[3 * i], n);
      EXPECT_EQ(scan.colours[3 * i + 2], 255 - n);
    }
  }
}

TEST(ReadPly, EqualCentresAreOneStation) {
  const Scan scan = read_one(attributed_ply(Writing::little, 100, true));
  ASSERT_EQ(scan.centres.size(), 1U);
  EXPECT_EQ(scan.centres[0] + scan.local_origin, Vector3d(1050000.5, 6839990.0, 102.0));
}

TEST(ReadPly, LeavesOutPointsThatAreNotFiniteAndCountsThem) {
  auto points = room_points(1000, 4);
  points[10].y() = std::numeric_limits<double>::quiet_NaN();
  points[999].z() = -std::numeric_limits<double>::infinity();
  for (const Writing writing : kWritings) {
    const ScanFile file = read_ply(simple_ply<double>(points, writing), "test.ply");
    EXPECT_EQ(file.dropped, 2U);
    ASSERT_EQ(file.scans[0].size(), 998U);
    EXPECT_EQ(file.scans[0].points[10], points[11]);
    EXPECT_EQ(file.unusable, 2U);
  }
}

TEST(ReadPly, ZeroIsTheScannerOnlyWhereItCanBe) {
  const auto room = room_points(20000, 5);
  EXPECT_EQ(read_one(simple_ply<double>(room, Writing::little)).centres,
            std::vector<Vector3d>{Vector3d::Zero()});
  auto beside = room;
  for (Vector3d& point : beside) point += Vector3d(100.0, 0.0, 0.0);
  EXPECT_FALSE(read_one(simple_ply<double>(beside, Writing::little)).centre_known());
  auto touched = room;
  for (std::size_t i = 0; i < 100; ++i) touched[i] *= 0.01;
  EXPECT_FALSE(read_one(simple_ply<double>(touched, Writing::little)).centre_known());
  const auto cloud = random_points(20000, {-5, -5, -5}, 10.0, 6);  // a solid block: most points are hidden
  EXPECT_FALSE(read_one(simple_ply<double>(cloud, Writing::little)).centre_known());
}

TEST(ReadPly, TheUsersOriginWins) {
  ReadOptions options;
  options.origin = Vector3d(1050010.0, 6840010.0, 101.5);
  const auto points = random_points(100, {10, 10, 1}, 5.0, 7);
  const Scan scan =
      read_one(simple_ply<float>(points, Writing::ascii, "comment offset 1050000 6840000 100\n"), options);
  ASSERT_EQ(scan.centres.size(), 1U);
  EXPECT_EQ(scan.centres[0] + scan.local_origin, *options.origin);
  options.origin = Vector3d(0.0, std::numeric_limits<double>::quiet_NaN(), 0.0);
  EXPECT_THROW(read_one(simple_ply<float>(points, Writing::ascii), options), Error);
}

TEST(ReadPly, DoesNotDependOnTheThreadCount) {
  const std::string ascii = simple_ply<double>(random_points(60000, {1e6, 6e6, 0}, 30.0, 8), Writing::ascii);
  set_thread_count(1);
  const Scan one = read_one(ascii);
  set_thread_count(7);
  const Scan many = read_one(ascii);
  set_thread_count(0);
  EXPECT_EQ(one.points, many.points);
}

TEST(ReadPly, TakesWindowsLineEndsAndWideColours) {
  std::string ply = "ply\r\nformat ascii 1.0\r\nelement vertex 2\r\nproperty float x\r\nproperty float y\r\n";
  ply +=
      "property float z\r\nproperty ushort red\r\nproperty ushort green\r\nproperty ushort "
      "blue\r\nend_header\r\n";
  ply += "1 2 3 65535 0 257\r\n+4 5e0 -6 32768 1 2";  // the last line without its end
  const Scan scan = read_one(ply);
  EXPECT_EQ(scan.points[1], Vector3d(4, 5, -6));
  EXPECT_EQ(scan.colours, (std::vector<std::uint8_t>{255, 0, 1, 128, 0, 0}));
}

}  // namespace
}  // namespace limen
