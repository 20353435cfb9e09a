// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/transform_cloud.h"

#include <gtest/gtest.h>

#include "limen/base/error.h"
#include "limen/io/ply_header.h"
#include "limen/io/test_support.h"

namespace limen {
namespace {

using namespace testing_io;

constexpr Writing kWritings[] = {Writing::ascii, Writing::little, Writing::big};

/// From a station's own frame to the national grid.
Rigid3 grid_from_station() {
  return {rotation_exp({0.0, 0.0, 0.7}), {1050012.345678, 6840034.567891, 142.125}};
}

/// Points with values before, between and behind the coordinates, a list, normals, and faces behind them.
std::string rich_ply(Writing w, const std::vector<Vector3d>& points, const std::string& comment) {
  std::string ply =
      format_line(w) + comment + "comment keep me\nelement lead 1\nproperty int a\n" +
      fmt::format("element vertex {}\n", points.size()) +
      "property uchar class\nproperty float x\nproperty float y\nproperty short s\nproperty float z\n"
      "property float nx\nproperty float ny\nproperty float nz\nproperty list uchar int ids\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n" +
      number(std::int32_t{77}, w) + row_end(w);
  for (std::size_t i = 0; i < points.size(); ++i) {
    ply += number(static_cast<std::uint8_t>(i % 200), w);
    ply += number(static_cast<float>(points[i].x()), w) + number(static_cast<float>(points[i].y()), w);
    ply += number(static_cast<std::int16_t>(-static_cast<int>(i)), w) +
           number(static_cast<float>(points[i].z()), w);
    for (const float n : {1.0F, 0.0F, 0.0F}) ply += number(n, w);
    ply += number(static_cast<std::uint8_t>(i % 3), w);
    for (std::size_t k = 0; k < i % 3; ++k) ply += number(std::int32_t{5}, w);
    ply += row_end(w);
  }
  ply += number(std::uint8_t{3}, w);
  for (int k = 0; k < 3; ++k) ply += number(std::int32_t{k}, w);
  return ply + row_end(w);
}

TEST(TransformCloud, MovesThePointsAndKeepsEverythingElse) {
  const TemporaryFolder folder;
  const auto points = room_points(3000, 1);
  const Rigid3 pose = grid_from_station();
  for (const Writing writing : kWritings) {
    const auto in = folder.write("in.ply", rich_ply(writing, points, ""));
    EXPECT_EQ(transform_cloud(in, pose, folder / "out.ply").points, points.size());
    const Scan before = read_scan(in);
    const ScanFile after_file = read_scan_file(folder / "out.ply");
    const Scan& after = after_file.scans.front();
    EXPECT_EQ(after_file.fields, read_scan_file(in).fields);
    ASSERT_EQ(after.size(), before.size());
    for (std::size_t i = 0; i < after.size(); ++i)
      ASSERT_LT((after.local_origin + after.points[i] - pose * before.points[i]).norm(), 3e-9);
    // The scanner stood at 0 0 0 and is told in a comment now.
    ASSERT_EQ(after.centres.size(), 1U);
    EXPECT_LT((after.local_origin + after.centres[0] - pose.translation).norm(), 1e-9);
    EXPECT_NE(slurp(folder / "out.ply").find("comment keep me\n"), std::string::npos);
  }
}

TEST(TransformCloud, ThereAndBackGivesTheSameBytesBehindTheCoordinates) {
  const TemporaryFolder folder;
  const Rigid3 pose = grid_from_station();
  const std::string one = rich_ply(Writing::big, room_points(200, 2), "");
  transform_cloud(folder.write("a.ply", one), pose, folder / "b.ply");
  const std::string two = slurp(folder / "b.ply");
  // One record of the file by hand: class, x, y (double now), s, z, nx ny nz turned, the list's count.
  const PlyHeader header = parse_ply_header(two, "b.ply");
  const std::size_t first = ply_element_start(two, header, 1, "b.ply");
  EXPECT_EQ(two[first], '\0');
  EXPECT_EQ(two.substr(first + 17, 2), bytes_of(std::int16_t{0}, true));
  EXPECT_EQ(two.substr(first + 27, 4), bytes_of(static_cast<float>(pose.rotation(0, 0)), true));
  EXPECT_EQ(two.substr(first + 31, 4), bytes_of(static_cast<float>(pose.rotation(1, 0)), true));
  EXPECT_EQ(two.substr(two.size() - 13), one.substr(one.size() - 13)) << "the face behind the points";
}

TEST(TransformCloud, AnOffsetIsAddedAndTakenOut) {
  const TemporaryFolder folder;
  const auto points = random_points(1000, {10.0, 10.0, 1.0}, 30.0, 3);
  const Rigid3 pose{rotation_exp({0.0, 0.0, 0.001}), {0.5, -0.25, 0.125}};
  const auto in =
      folder.write("in.ply", rich_ply(Writing::little, points, "comment offset Pos 649000 6840000 0\n"));
  transform_cloud(in, pose, folder / "out.ply");
  EXPECT_EQ(slurp(folder / "out.ply").find("649000"), std::string::npos);
  const Scan before = read_scan(in);
  const Scan after = read_scan(folder / "out.ply");
  EXPECT_FALSE(after.centre_known());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector3d wanted = pose * (before.local_origin + before.points[i]);
    ASSERT_LT((after.local_origin + after.points[i] - wanted).norm(), 3e-9);
  }
}

TEST(TransformCloud, OtherFormatsBecomePly) {
  const TemporaryFolder folder;
  const auto in = folder.write("in.xyz", "1 2 3 0.5\n4 5 6 0.75\n");
  const Rigid3 pose = grid_from_station();
  EXPECT_TRUE(transform_cloud(in, pose, folder / "out.ply").notes.empty());
  const Scan after = read_scan(folder / "out.ply");
  EXPECT_LT((after.local_origin + after.points[1] - pose * Vector3d(4, 5, 6)).norm(), 3e-9);
  EXPECT_EQ(after.intensities, (std::vector<float>{0.5F, 0.75F}));
}

TEST(TransformCloud, TellsWhatOtherFormatsLose) {
  const TemporaryFolder folder;
  const auto in = folder.write("in.csv", "x,y,z,Classification,nx\n1,2,3,4,5\n6,7,8,9,0\n");
  const auto notes = transform_cloud(in, Rigid3{}, folder / "out.ply").notes;
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("classification, nx"), std::string::npos);
}

TEST(TransformCloud, LeavesNothingBehindWhereTheInputIsBroken) {
  const TemporaryFolder folder;
  std::string ply = simple_ply<float>(room_points(100, 4), Writing::little);
  ply.resize(ply.size() - 5);
  const auto in = folder.write("in.ply", ply);
  EXPECT_THROW(transform_cloud(in, Rigid3{}, folder / "out.ply"), Error);
  EXPECT_EQ(folder.files(), 1U);
}

TEST(TransformCloud, MayReplaceItsInput) {
  const TemporaryFolder folder;
  const auto in = folder.write("in.ply", simple_ply<double>(room_points(100, 5), Writing::little));
  transform_cloud(in, grid_from_station(), in);
  EXPECT_GT(read_scan(in).local_origin.norm(), 1e6);
}

}  // namespace
}  // namespace limen
