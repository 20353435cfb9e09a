// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/cloud/transform_cloud.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "support/test_support.h"
#include <gtest/gtest.h>

#include "limen/base/angles.h"
#include "limen/base/error.h"
#include "limen/io/cloud/join_clouds.h"
#include "limen/io/cloud/read_scan.h"
#include "limen/io/las/las.h"
#include "limen/io/ply/ply_header.h"
#include "limen/io/table/packed_rows.h"

namespace limen {
namespace {

using namespace testing_io;

constexpr Writing kCloudWritings[] = {Writing::ascii, Writing::little, Writing::big};

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

/// A column is a float in one cloud, bytes in the other, and a third cloud lacks it: the rows of all can be
/// mixed.
TEST(JoinedClouds, ColumnsOfOneNameAreOfOneKind) {
  const TemporaryFolder folder;
  const auto cloud = [](const std::string& column, const std::string& value) {
    return "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n" +
           column + "end_header\n1 2 3 " + value + "\n";
  };
  const OpenPoints floats(folder.write("a.ply", cloud("property float intensity\n", "0.5")));
  const OpenPoints bytes(folder.write("b.ply", cloud("property uchar intensity\n", "7")));
  const OpenPoints none(folder.write("c.ply", cloud("", "")));
  const JoinedClouds joined({{&floats, 0, {}}, {&bytes, 0, {}}, {&none, 0, {}}}, false);
  PackedRows rows;
  std::vector<double> values;
  const auto stream = joined.read();
  while (const std::optional<RecordTable> piece = stream->next(10)) {
    rows.require_columns(*piece);
    load_numbers(*piece, *piece->find({"intensity"}), {0, 1}, &values.emplace_back());
  }
  ASSERT_EQ(values.size(), 3U);
  EXPECT_EQ(values[0], 0.5);
  EXPECT_EQ(values[1], 7.0);
  EXPECT_TRUE(std::isnan(values[2]));
}

TEST(JoinedClouds, ColoursAreBroughtToOneKind) {
  const TemporaryFolder folder;
  const auto cloud = [](const std::string& type, const std::string& colour) {
    std::string text = "ply\nformat ascii 1.0\nelement vertex 1\n";
    for (const char* name : {"x", "y", "z"}) text += std::string("property float ") + name + "\n";
    for (const char* name : {"red", "green", "blue"}) text += "property " + type + " " + name + "\n";
    return text + "end_header\n1 2 3 " + colour + "\n";
  };
  const OpenPoints bytes(folder.write("a.ply", cloud("uchar", "0 128 255")));
  const OpenPoints words(folder.write("b.ply", cloud("ushort", "65535 32896 0")));
  const OpenPoints fractions(folder.write("c.ply", cloud("float", "0.5 1 0")));
  const JoinedClouds joined({{&bytes, 0, {}}, {&words, 0, {}}, {&fractions, 0, {}}}, false);
  std::vector<double> green;
  const auto stream = joined.read();
  while (const std::optional<RecordTable> piece = stream->next(10))
    load_numbers(*piece, *piece->find({"green"}), {0, 1}, &green.emplace_back());
  EXPECT_EQ(green, (std::vector<double>{32896.0, 32896.0, 65535.0}));
}

/// LAS has one kind of intensities, whatever the first rows look like.
TEST(TransformCloud, IntensitiesOfTheLastPointsCount) {
  const TemporaryFolder folder;
  std::string text = "x y z intensity\n";
  for (int i = 0; i < 300000; ++i) text += "1 2 3 0.0\n";
  transform_cloud(folder.write("in.xyz", text + "4 5 6 0.5\n"), {}, folder / "out.las");
  const std::string bytes = slurp(folder / "out.las");
  const std::size_t last = bytes.size() - parse_las_header(bytes, "test").point_bytes;
  std::uint16_t intensity = 0;
  std::memcpy(&intensity, &bytes[last + 12], sizeof intensity);
  EXPECT_EQ(intensity, 32768);
}

TEST(TransformCloud, MovesThePointsAndKeepsEverythingElse) {
  const TemporaryFolder folder;
  const auto points = room_points(3000, 1);
  const Rigid3 pose = grid_from_station();
  for (const Writing writing : kCloudWritings) {
    const auto in = folder.write("in.ply", rich_ply(writing, points, ""));
    EXPECT_EQ(transform_cloud(in, pose, folder / "out.ply").points, points.size());
    const Scan before = read_scan(in);
    const ScanFile after_file = read_scan_file(folder / "out.ply");
    const Scan& after = after_file.scans.front();
    EXPECT_EQ(after_file.fields, read_scan_file(in).fields);
    ASSERT_EQ(after.size(), before.size());
    for (std::size_t i = 0; i < after.size(); ++i)
      ASSERT_LT((after.local_origin + after.points[i] - pose * before.points[i]).norm(), 3e-9);
    // The scanner stood at 0 0 0 and is stated in a comment now.
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

TEST(TransformCloud, EveryColumnGoesIntoAnotherFormat) {
  const TemporaryFolder folder;
  const auto in = folder.write("in.csv", "x,y,z,Classification,nx,ny,nz\n1,2,3,4,1,0,0\n6,7,8,9,0,1,0\n");
  const Rigid3 turn{rotation_exp({0.0, 0.0, 0.5}), {0, 0, 0}};
  EXPECT_TRUE(transform_cloud(in, turn, folder / "out.ply").notes.empty());
  const std::string ply = slurp(folder / "out.ply");
  EXPECT_NE(ply.find("property double classification\n"), std::string::npos);
  const PlyHeader header = parse_ply_header(ply, "out.ply");
  EXPECT_EQ(ply.size() - header.body, 2U * 7U * 8U);
  EXPECT_EQ(ply.substr(header.body + 24, 8), bytes_of(4.0));
  EXPECT_EQ(ply.substr(header.body + 32, 8), bytes_of(turn.rotation(0, 0)));
}

TEST(TransformCloud, TextKeepsTheRestOfItsLines) {
  const TemporaryFolder folder;
  const auto in =
      folder.write("in.xyz", "# made by hand\r\n 1.5,\t2 3.123456 0.5 abc\r\n\r\n4 5 6 0.75 \"d\"\r\n");
  const Rigid3 pose{Matrix3d::Identity(), {10.0, 20.25, 30.0}};
  EXPECT_EQ(transform_cloud(in, pose, folder / "out.xyz").points, 2U);
  EXPECT_EQ(
      slurp(folder / "out.xyz"),
      "# made by hand\r\n 11.5000,\t22.2500 33.123456 0.5 abc\r\n\r\n14.0000 25.2500 36.0000 0.75 \"d\"\r\n");
}

TEST(TransformCloud, TextStatesWhereTheScannerIsThen) {
  const TemporaryFolder folder;
  const auto in = folder.write("in.xyz", "// scanner_position 1 2 3\r\n// x y z\r\n1.5 2 3\r\n4 5 6\r\n");
  transform_cloud(in, Rigid3{Matrix3d::Identity(), {652000.0, 6840000.0, 35.0}}, folder / "out.xyz");
  EXPECT_EQ(slurp(folder / "out.xyz").substr(0, 66),
            "// scanner_position 652001.000000 6840002.000000 38.000000\r\n// x y");
  const Scan scan = read_scan(folder / "out.xyz");
  ASSERT_TRUE(scan.centre_known());
  EXPECT_LT((scan.local_origin + scan.centres[0] - Vector3d(652001, 6840002, 38)).norm(), 1e-6);
}

TEST(TransformCloud, AStatedScannerPositionIsReadWhereItIsMoved) {
  const TemporaryFolder folder;
  const Rigid3 motion{Matrix3d::Identity(), {100.0, 0.0, 0.0}};
  transform_cloud(folder.write("bom.xyz", "\xEF\xBB\xBF// scanner_position 1 2 3\n1.5 2 3\n4 5 6\n"), motion,
                  folder / "moved.xyz");
  const Scan moved = read_scan(folder / "moved.xyz");
  ASSERT_TRUE(moved.centre_known());
  EXPECT_LT((moved.local_origin + moved.centres[0] - Vector3d(101, 2, 3)).norm(), 1e-6);
  // Behind a count the lines are rows, or nothing.
  const Scan counted = read_scan(folder.write("c.pts", "2\n// scanner_position 7 7 7\n1.5 2 3\n4 5 6\n"));
  EXPECT_FALSE(counted.centre_known());
}

TEST(TransformCloud, AStationWithoutReturnsIsNoFault) {
  const TemporaryFolder folder;
  const std::string head = "2\n2\n1 2 3\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n1 2 3 1\n";
  const auto in = folder.write("two.ptx", head + "1 2 3 0.5\n2 2 3 0.5\n4 5 6 0.25\n-7 8 9 1\n" + head +
                                              "0 0 0 0.5\n0 0 0 0.5\n0 0 0 0.5\n0 0 0 0.5\n");
  EXPECT_EQ(transform_cloud(in, {}, folder / "out.e57").points, 8U);
}

TEST(TransformCloud, TextMovesTheColumnsThatAreNamed) {
  const TemporaryFolder folder;
  const auto in = folder.write("in.csv", "nx;ny;nz;id;x;y;z\n1;0;0;7;1;2;3\n");
  const Rigid3 pose{rotation_exp({0.0, 0.0, radians(90.0)}), {0.0, 0.0, 0.5}};
  transform_cloud(in, pose, folder / "out.csv");
  EXPECT_EQ(slurp(folder / "out.csv"), "nx;ny;nz;id;x;y;z\n0.0000;1.0000;0.0000;7;-2.0000;1.0000;3.5000\n");
}

TEST(TransformCloud, PtsKeepsItsCounts) {
  const TemporaryFolder folder;
  const auto in = folder.write("in.pts", "2\n1 2 3 9 1 2 3\n4 5 6 9 1 2 3\n");
  transform_cloud(in, Rigid3{Matrix3d::Identity(), {1, 1, 1}}, folder / "out.pts");
  EXPECT_EQ(slurp(folder / "out.pts"), "2\n2.0000 3.0000 4.0000 9 1 2 3\n5.0000 6.0000 7.0000 9 1 2 3\n");
}

TEST(TransformCloud, PtxKeepsItsPointsAndMovesItsScanners) {
  const TemporaryFolder folder;
  const std::string rows = "1 2 3 0.5\n0 0 0 0.5\n4 5 6 0.25\n-7 8 9 1\n";
  const std::string head = "2\n2\n1 2 3\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n1 2 3 1\n";
  const auto in = folder.write("in.ptx", head + rows + head + rows);
  const Rigid3 pose = grid_from_station();
  EXPECT_EQ(transform_cloud(in, pose, folder / "out.ptx").points, 8U);
  const std::string out = slurp(folder / "out.ptx");
  EXPECT_EQ(out.substr(out.size() - rows.size()), rows);
  const auto before = read_scans(in);
  const auto after = read_scans(folder / "out.ptx");
  ASSERT_EQ(after.size(), 2U);
  for (std::size_t k = 0; k < 2; ++k) {
    ASSERT_EQ(after[k].size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector3d wanted = pose * (before[k].local_origin + before[k].points[i]);
      EXPECT_LT((after[k].local_origin + after[k].points[i] - wanted).norm(), 3e-9);
    }
    EXPECT_LT((after[k].local_origin + after[k].centres[0] - pose * Vector3d(1, 2, 3)).norm(), 3e-9);
  }
}

TEST(TransformCloud, APtxThatCannotBeReadIsNotCopied) {
  const TemporaryFolder folder;
  const std::string head = "2\n1\n1 2 3\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n1 2 3 1\n";
  const auto in = folder.write("in.ptx", head + "1 2 3 0.5\nnothing\n");
  EXPECT_THROW(transform_cloud(in, {}, folder / "out.ptx"), Error);
  EXPECT_FALSE(std::filesystem::exists(folder / "out.ptx"));
}

TEST(TransformCloud, PtxFindsItsScansBehindEmptyLinesAsTheReaderDoes) {
  const TemporaryFolder folder;
  const std::string rows = "1 2 3 0.5\n4 5 6 0.25\n";
  const std::string head = "1\n2\n1 2 3\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n1 2 3 1\n";
  const auto in = folder.write("in.ptx", "     \n" + head + rows + "      \n" + head + rows + "     \n");
  transform_cloud(in, Rigid3{Matrix3d::Identity(), {10, 20, 30}}, folder / "out.ptx");
  const std::string moved = "1\n2\n11 22 33\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n11 22 33 1\n";
  EXPECT_EQ(slurp(folder / "out.ptx"), "     \n" + moved + rows + "      \n" + moved + rows + "     \n");
  const auto cut = folder.write("cut.ptx", head + rows + head + "1 2 3 0.5\n");
  EXPECT_THROW(transform_cloud(cut, Rigid3{}, folder / "cut_out.ptx"), Error);
  EXPECT_FALSE(std::filesystem::exists(folder / "cut_out.ptx"));
}

TEST(TransformCloud, ATextWithoutColumnsIsStatedAsSuch) {
  const TemporaryFolder folder;
  const auto in = folder.write("in.pcd",
                               "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 0 0 0\nWIDTH 1\n"
                               "HEIGHT 1\nPOINTS 1\nDATA ascii\n1 2 3\n");
  EXPECT_THROW(transform_cloud(in, Rigid3{}, folder / "out.ply"), Error);
}

/// A PCD with a number before and an array behind the coordinates.
std::string rich_pcd(const std::string& data, const std::vector<Vector3d>& points) {
  std::string pcd = fmt::format(
      "# .PCD v0.7\nVERSION 0.7\nFIELDS id x y z bins\nSIZE 2 4 4 4 1\nTYPE U F F F U\nCOUNT 1 1 1 1 3\n"
      "WIDTH {0}\nHEIGHT 1\nVIEWPOINT 0.5 0 0 1 0 0 0\nPOINTS {0}\nDATA {1}\n",
      points.size(), data);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto id = static_cast<std::uint16_t>(i);
    if (data == "ascii") {
      pcd += fmt::format("{} {} {} {} 1 2 3\n", id, static_cast<float>(points[i].x()),
                         static_cast<float>(points[i].y()), static_cast<float>(points[i].z()));
      continue;
    }
    pcd += bytes_of(id);
    for (int k = 0; k < 3; ++k) pcd += bytes_of(static_cast<float>(points[i][k]));
    pcd += "abc";
  }
  return pcd;
}

TEST(TransformCloud, PcdKeepsItsFieldsAndMovesItsViewPoint) {
  const TemporaryFolder folder;
  const auto points = room_points(500, 9);
  const Rigid3 pose = grid_from_station();
  for (const char* data : {"binary", "ascii"}) {
    const auto in = folder.write("in.pcd", rich_pcd(data, points));
    EXPECT_EQ(transform_cloud(in, pose, folder / "out.pcd").points, points.size());
    const std::string out = slurp(folder / "out.pcd");
    EXPECT_NE(out.find("SIZE 2 8 8 8 1\nTYPE U F F F U\n"), std::string::npos);
    EXPECT_NE(out.find("VIEWPOINT 1050012"), std::string::npos);
    EXPECT_EQ(out.substr(out.size() - 3), data[0] == 'b' ? "abc" : " 3\n");
    const Scan before = read_scan(in);
    const Scan after = read_scan(folder / "out.pcd");
    ASSERT_EQ(after.size(), points.size());
    const double tolerance = data[0] == 'b' ? 3e-9 : 1e-4;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vector3d wanted = pose * (before.local_origin + before.points[i]);
      ASSERT_LT((after.local_origin + after.points[i] - wanted).norm(), tolerance);
    }
  }
}

TEST(TransformCloud, LeavesNothingBehindWhereRowsAreMissing) {
  const TemporaryFolder folder;
  const std::string head = "2\n2\n1 2 3\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n1 2 3 1\n";
  const std::string pcd = rich_pcd("ascii", room_points(5, 9));
  const std::string binary = rich_pcd("binary", room_points(5, 9));
  const std::pair<const char*, std::string> broken[] = {{"in.ptx", head + "1 2 3 0.5\n"},
                                                        {"in.pcd", pcd.substr(0, pcd.size() - 40)},
                                                        {"in2.pcd", binary.substr(0, binary.size() - 40)},
                                                        {"in.pts", "3\n1 2 3\n4 5 6\n"},
                                                        {"in.xyz", "1 2 3\n4 5\n"}};
  std::size_t files = 0;
  for (const auto& [name, bytes] : broken) {
    const auto in = folder.write(name, bytes);
    ++files;
    EXPECT_THROW(transform_cloud(in, Rigid3{}, folder / ("out" + in.extension().string())), Error) << name;
    EXPECT_THROW(transform_cloud(in, Rigid3{}, folder / "out.ply"), Error) << name;
    EXPECT_EQ(folder.files(), files) << name;
  }
}

TEST(TransformCloud, MergesWithTheColumnsOfAll) {
  const TemporaryFolder folder;
  const auto points = room_points(400, 11);
  const auto moved =
      folder.write("a.ply", simple_ply<double>(points, Writing::big, "comment scanner_position 0 0 0\n"));
  const auto other = folder.write("b.csv", "x,y,z,Label\n1000,2,3,4\n1000,5,6,7\n");
  const Rigid3 pose = grid_from_station();
  const TransformedCloud merged = merge_clouds({moved, pose}, {other.string()}, folder / "out.ply");
  EXPECT_EQ(merged.points, points.size() + 2);
  const std::string ply = slurp(folder / "out.ply");
  const PlyHeader header = parse_ply_header(ply, "out.ply");
  ASSERT_EQ(header.elements[0].count, points.size() + 2);
  std::vector<std::string> names;
  for (const PlyProperty& property : header.elements[0].properties) names.push_back(property.name);
  EXPECT_EQ(names, (std::vector<std::string>{"x", "y", "z", "label", "x_origin", "y_origin", "z_origin",
                                             "source_cloud"}));
  const std::size_t record = 7 * 8 + 1;
  const std::size_t last = ply.size() - record;
  EXPECT_EQ(ply.substr(last, 8), bytes_of(1000.0));
  EXPECT_EQ(ply.substr(last + 24, 8), bytes_of(7.0));
  EXPECT_EQ(ply.back(), '\1');
  EXPECT_EQ(ply[header.body + record - 1], '\0');
  double x = 0.0;
  std::memcpy(&x, ply.data() + header.body, sizeof x);
  EXPECT_NEAR(x, (pose * points[0]).x(), 3e-9);
  std::memcpy(&x, ply.data() + header.body + 32, sizeof x);
  EXPECT_NEAR(x, pose.translation.x(), 3e-9);
}

TEST(TransformCloud, GoesThroughLasAndE57) {
  const TemporaryFolder folder;
  const auto points = room_points(3000, 12);
  std::string csv = "x,y,z,intensity,gps_time,red,green,blue,quality\n";
  for (std::size_t i = 0; i < points.size(); ++i) {
    csv += fmt::format("{},{},{},{},{},{},{},{},{}\n", points[i].x(), points[i].y(), points[i].z(), i % 700,
                       1e5 + 0.25 * static_cast<double>(i), i % 256, 255 - i % 256, 7,
                       0.5 * static_cast<double>(i));
  }
  const auto in = folder.write("in.csv", csv);
  const Scan before = read_scan(in);
  for (const char* name : {"out.las", "out.e57"}) {
    transform_cloud(in, grid_from_station(), folder / name);
    const ScanFile file = read_scan_file(folder / name);
    const Scan& after = file.scans.front();
    ASSERT_EQ(after.size(), before.size()) << name;
    EXPECT_EQ(after.times_s, before.times_s) << name;
    EXPECT_EQ(after.colours, before.colours) << name;
    EXPECT_EQ(after.intensities, before.intensities) << name;
    EXPECT_NE(std::find(file.fields.begin(), file.fields.end(), "quality"), file.fields.end()) << name;
    for (std::size_t i = 0; i < after.size(); ++i) {
      const Vector3d wanted = grid_from_station() * before.points[i];
      ASSERT_LT((after.local_origin + after.points[i] - wanted).norm(), 1e-4) << name;
    }
    // And moved back in its own format.
    transform_cloud(folder / name, inverse(grid_from_station()), folder / (std::string("back-") + name));
    const Scan back = read_scan(folder / (std::string("back-") + name));
    ASSERT_EQ(back.size(), before.size()) << name;
    for (std::size_t i = 0; i < back.size(); ++i)
      ASSERT_LT((back.local_origin + back.points[i] - before.points[i]).norm(), 2e-4) << name;
    EXPECT_EQ(back.times_s, before.times_s) << name;
  }
}

TEST(TransformCloud, RefusesEndingsItDoesNotWrite) {
  const TemporaryFolder folder;
  const auto in = folder.write("in.xyz", "1 2 3\n4 5 6\n");
  for (const char* name : {"out.copc", "out.pcd", "out.jpg"}) {
    EXPECT_THROW(transform_cloud(in, Rigid3{}, folder / name), Error) << name;
  }
  EXPECT_EQ(folder.files(), 1U);
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
