// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <bit>

#include "support/test_support.h"
#include <gtest/gtest.h>

#include "limen/io/pcd/pcd.h"

namespace limen {
namespace {

using namespace testing_io;

const char* const kHeader =
    "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z intensity rgb normal _\n"
    "SIZE 4 8 4 2 4 4 1\nTYPE F F F U F F U\nCOUNT 1 1 1 1 1 3 2\n";

std::string header(const std::string& size_lines, const std::string& data) {
  return kHeader + size_lines + "DATA " + data + "\n";
}

struct Row {
  float x;
  double y;
  float z;
  std::uint16_t intensity;
  std::uint32_t rgb;
};

std::vector<Row> rows() {
  std::vector<Row> all;
  for (int i = 0; i < 12; ++i) {
    const auto f = static_cast<float>(i);
    const auto u = static_cast<std::uint32_t>(i);
    all.push_back(
        {f, 1000.125 + i, -f, static_cast<std::uint16_t>(100 * i), (u << 16U) | ((2 * u) << 8U) | (3 * u)});
  }
  return all;
}

std::string binary_body() {
  std::string body;
  for (const Row& row : rows()) {
    body += bytes_of(row.x) + bytes_of(row.y) + bytes_of(row.z) + bytes_of(row.intensity) + bytes_of(row.rgb);
    body += bytes_of(1.0F) + bytes_of(0.0F) + bytes_of(0.0F) + "??";
  }
  return body;
}

std::string ascii_body() {
  std::string body;
  for (const Row& row : rows()) {
    body += fmt::format("{} {} {} {} {} 1 0 0 7 7\n", row.x, row.y, row.z, row.intensity,
                        std::bit_cast<float>(row.rgb));
  }
  return body;
}

std::string compressed_body() {
  std::string columns;
  for (const Row& row : rows()) columns += bytes_of(row.x);
  for (const Row& row : rows()) columns += bytes_of(row.y);
  for (const Row& row : rows()) columns += bytes_of(row.z);
  for (const Row& row : rows()) columns += bytes_of(row.intensity);
  for (const Row& row : rows()) columns += bytes_of(row.rgb);
  columns += std::string(std::size_t{12} * 14, 'n');
  const std::string packed = pack_lzf(columns);
  return bytes_of(static_cast<std::uint32_t>(packed.size())) +
         bytes_of(static_cast<std::uint32_t>(columns.size())) + packed;
}

void expect_rows(const Scan& scan) {
  scan.check();
  ASSERT_EQ(scan.size(), 12U);
  for (std::size_t i = 0; i < 12; ++i) {
    const auto n = static_cast<int>(i);
    EXPECT_EQ(scan.points[i] + scan.local_origin, Vector3d(n, 1000.125 + n, -n));
    EXPECT_EQ(scan.intensities[i], static_cast<float>(100 * n));
    EXPECT_EQ(scan.colours[3 * i], n);
    EXPECT_EQ(scan.colours[3 * i + 1], 2 * n);
    EXPECT_EQ(scan.colours[3 * i + 2], 3 * n);
  }
}

TEST(ReadPcd, ReadsAllEncodings) {
  const std::string size = "WIDTH 12\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 12\n";
  expect_rows(read_pcd(header(size, "ascii") + ascii_body(), "a.pcd").scans.at(0));
  expect_rows(read_pcd(header(size, "binary") + binary_body(), "b.pcd").scans.at(0));
  expect_rows(read_pcd(header(size, "binary_compressed") + compressed_body(), "c.pcd").scans.at(0));
}

TEST(ReadPcd, RowsAndColumnsAreATopology) {
  const std::string size = "WIDTH 4\nHEIGHT 3\nPOINTS 12\n";
  const Scan scan = read_pcd(header(size, "binary") + binary_body(), "b.pcd").scans.at(0);
  expect_rows(scan);
  ASSERT_TRUE(scan.topology.known());
  EXPECT_EQ(scan.topology.line[6], 2);
  EXPECT_EQ(scan.topology.index[6], 1);
}

TEST(ReadPcd, TakesThePointsWhereTheWidthIsZero) {
  expect_rows(
      read_pcd(header("WIDTH 0\nHEIGHT 1\nPOINTS 12\n", "binary") + binary_body(), "b.pcd").scans.at(0));
  expect_rows(read_pcd(header("WIDTH 12\nHEIGHT 1\n", "binary") + binary_body(), "b.pcd").scans.at(0));
}

std::string room_pcd(const Vector3d& shift, const std::string& viewpoint) {
  const auto points = room_points(5000, 1);
  std::string file =
      "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 5000\nHEIGHT 1\n" + viewpoint +
      "POINTS 5000\nDATA binary\n";
  for (const Vector3d& point : points) {
    for (int k = 0; k < 3; ++k) file += bytes_of(static_cast<float>(point[k] + shift[k]));
  }
  return file;
}

TEST(ReadPcd, TheViewpointIsTheCentreWhereItCanBe) {
  const Scan moved = read_pcd(room_pcd({20, 30, 2}, "VIEWPOINT 20 30 2 1 0 0 0\n"), "v.pcd").scans.at(0);
  EXPECT_EQ(moved.centres, std::vector<Vector3d>{Vector3d(20, 30, 2)});
  const Scan sensor = read_pcd(room_pcd({0, 0, 0}, "VIEWPOINT 20 30 2 1 0 0 0\n"), "v.pcd").scans.at(0);
  EXPECT_EQ(sensor.centres, std::vector<Vector3d>{Vector3d::Zero()}) << "a pose: the points are in its frame";
  EXPECT_FALSE(read_pcd(room_pcd({20, 30, 2}, ""), "v.pcd").scans.at(0).centre_known());
}

TEST(ReadPcd, NotANumberIsLeftOut) {
  const std::string file =
      "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 2\nHEIGHT 2\nPOINTS 4\nDATA "
      "ascii\n"
      "1 2 3\nnan nan nan\n4 5 6\n-nan 1 inf\n";
  const ScanFile read = read_pcd(file, "n.pcd");
  EXPECT_EQ(read.dropped, 2U);
  EXPECT_EQ(read.scans[0].points[1], Vector3d(4, 5, 6));
  EXPECT_EQ(read.scans[0].topology.index[1], 1);
}

}  // namespace
}  // namespace limen
