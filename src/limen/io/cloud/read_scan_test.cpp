// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/cloud/read_scan.h"

#include <cmath>

#include "support/test_support.h"
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "limen/base/error.h"

namespace limen {
namespace {

using namespace testing_io;
using std::string_literals::operator""s;

/// A broken file: its name, its bytes, and words that its one error must say.
struct Broken {
  std::string name;
  std::string bytes;
  std::string says;
};

const std::string kPly = "ply\nformat binary_little_endian 1.0\n";
const std::string kXyzFloat = "property float x\nproperty float y\nproperty float z\n";
const std::string kTwelve(12, 'a');

std::string pcd(const std::string& points, const std::string& data) {
  return "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n" + points + "DATA " + data + "\n";
}

const std::string kPtxHead = "2\n1\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
const std::string kIdentity = "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n";

std::vector<Broken> broken_ply() {
  const std::string vertex = kPly + "element vertex ";
  return {
      {"empty.ply", "", "empty"},
      {"no_end.ply", kPly + "element vertex 1\n" + kXyzFloat, "end_header"},
      {"no_format.ply", "ply\nelement vertex 1\n" + kXyzFloat + "end_header\n" + kTwelve, "format"},
      {"new_format.ply", "ply\nformat binary_middle_endian 1.0\nend_header\n", "line 2"},
      {"no_vertex.ply", kPly + "element face 0\nend_header\n", "no element \"vertex\""},
      {"no_points.ply", vertex + "0\n" + kXyzFloat + "end_header\n", "no points"},
      {"truncated.ply", vertex + "3\n" + kXyzFloat + "end_header\n" + kTwelve + kTwelve, "promises 3 points"},
      {"absurd.ply", vertex + "9000000000000000000\n" + kXyzFloat + "end_header\n" + kTwelve, "promises"},
      {"overflow.ply", vertex + "99999999999999999999999\n" + kXyzFloat + "end_header\n", "line 3"},
      {"negative.ply", vertex + "-5\n" + kXyzFloat + "end_header\n", "line 3"},
      {"no_z.ply", vertex + "1\nproperty float x\nproperty float y\nend_header\n" + kTwelve, "no z"},
      {"bad_type.ply", vertex + "1\nproperty quad x\nend_header\n", "unknown number type \"quad\""},
      {"bad_word.ply", vertex + "1\nproprety float x\nend_header\n", "unknown word"},
      {"early_property.ply", kPly + kXyzFloat + "end_header\n", "before the first element"},
      {"float_list.ply", vertex + "1\nproperty list float int a\nend_header\n", "whole number"},
      {"nan.ply",
       simple_ply<float>({Vector3d::Constant(std::nan("")), Vector3d::Constant(std::nan(""))}, Writing::big),
       "no usable points"},
      {"extent.ply", simple_ply<double>({{1, 0, 0}, {5e7, 0, 0}}, Writing::little), "absurd extent"},
      {"short_text.ply", "ply\nformat ascii 1.0\nelement vertex 2\n" + kXyzFloat + "end_header\n1 2 3\n1 2\n",
       "line 9"},
      {"few_text.ply", "ply\nformat ascii 1.0\nelement vertex 3\n" + kXyzFloat + "end_header\n1 2 3\n1 2 3\n",
       "2 of 3 points"},
      {"word_text.ply", "ply\nformat ascii 1.0\nelement vertex 1\n" + kXyzFloat + "end_header\n1 two 3\n",
       "line 8"},
      {"face_first.ply",
       kPly + "element face 1000000000\nproperty list uchar int i\nelement vertex 1\n" + kXyzFloat +
           "end_header\n" + kTwelve,
       "face"},
      {"long_list.ply",
       kPly + "element face 1\nproperty list uint double i\nelement vertex 1\n" + kXyzFloat + "end_header\n" +
           "\xFF\xFF\xFF\xFF"s + kTwelve,
       "face"},
      {"negative_list.ply",
       vertex + "1\n" + kXyzFloat + "property list char int i\nend_header\n" + kTwelve + "\xFF", "vertex"},
      {"not.ply", "polygon file\n", "line 1"},
  };
}

std::vector<Broken> broken_others() {
  const std::string packed = bytes_of(std::uint32_t{4}) + bytes_of(std::uint32_t{24});
  return {
      {"no_data.pcd", "VERSION 0.7\nFIELDS x y z\n", "DATA"},
      {"no_fields.pcd", "VERSION 0.7\nWIDTH 1\nDATA ascii\n1 2 3\n", "FIELDS"},
      {"zero.pcd", pcd("WIDTH 0\nHEIGHT 1\nPOINTS 0\n", "binary"), "no points"},
      {"truncated.pcd", pcd("WIDTH 3\nHEIGHT 1\nPOINTS 3\n", "binary") + kTwelve, "promises 3 points"},
      {"absurd.pcd", pcd("WIDTH 9999999999999\nHEIGHT 9999999999\n", "binary") + kTwelve, "promises"},
      {"few_text.pcd", pcd("WIDTH 3\nHEIGHT 1\nPOINTS 3\n", "ascii") + "1 2 3\n", "1 of 3"},
      {"data.pcd", pcd("POINTS 1\n", "zipped"), "unknown PCD data"},
      {"type.pcd", "VERSION 0.7\nFIELDS x y z\nSIZE 3 4 4\nTYPE F F F\nPOINTS 1\nDATA binary\n" + kTwelve,
       "unknown type"},
      {"sizes.pcd", "VERSION 0.7\nFIELDS x y z\nSIZE 4 4\nDATA ascii\n", "line 3"},
      {"packed_end.pcd", pcd("POINTS 2\n", "binary_compressed") + "\x01", "are cut off"},
      {"packed_bad.pcd", pcd("POINTS 2\n", "binary_compressed") + packed + "\xFF\xFF\xFF\xFF"s, "damaged"},
      {"packed_few.pcd",
       pcd("POINTS 2\n", "binary_compressed") + bytes_of(std::uint32_t{13}) + bytes_of(std::uint32_t{12}) +
           "\x0B" + kTwelve,
       "promises"},
      {"header.pcd", "1 2 3\n4 5 6\n", "line 1"},
      {"short.ptx", kPtxHead + kIdentity + "1 2 3 0.5\n", "1 of 2"},
      {"cut.ptx", kPtxHead + "1 0 0 0\n0 1 0", "4 numbers"},
      {"scale.ptx", kPtxHead + "2 0 0 0\n0 2 0 0\n0 0 2 0\n0 0 0 1\n1 2 3 0\n1 2 3 0\n", "rigid"},
      {"absurd.ptx", "9999999\n9999999" + kPtxHead.substr(3) + kIdentity + "1 2 3 0.5\n", "points"},
      {"missing.ptx", kPtxHead + kIdentity + "0 0 0 0\n0 0 0 0\n", "missing"},
      {"second.ptx", kPtxHead + kIdentity + "1 2 3 0\n4 5 6 0\n2\n1\n0 0\n", "line 15"},
      {"few.pts", "5\n1 2 3\n", "1 of 5"},
      {"absurd.pts", "18446744073709551615\n1 2 3\n", "points"},
      {"short_row.xyz", "1 2 3\n4 5\n", "line 2"},
      {"two.xyz", "1 2\n3 4\n", "three numbers"},
      {"commas.xyz", "1,5;2,5;3,5\n", "decimal commas"},
      {"commas.txt", "1,5 2,5 3,5\n", "decimal commas"},
      {"commas.csv", "1,5, 2,5, 3,5\n", "decimal commas"},
      {"returns.xyz", "1 2 3\r4 5 6\r7 8 9\r", "carriage return"},
      {"prose.txt", "To whom it may concern\n", "neither rows of numbers"},
      {"names_only.csv", "x,y,z\n", "no points"},
      {"nan.xyz", "nan nan nan\n", "no usable points"},
      {"picture.bin", "\x89PNG\r\n\x1A\n\0\0\0"s, "unknown format"},
      {"scan.e57", "ASTM-E57" + std::string(100, '\0'), "E57"},
      {"scan.las", "LASF" + std::string(400, '\0'), "LAS"},
      {"model.ifc", "ISO-10303-21;\nHEADER;\n", "IFC"},
  };
}

void expect_error(const TemporaryFolder& folder, const Broken& broken) {
  const auto path = folder.write(broken.name, broken.bytes);
  try {
    read_scan(path);
    ADD_FAILURE() << broken.name << " was read";
  } catch (const Error& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find(broken.says), std::string::npos) << broken.name << ": " << text;
    EXPECT_NE(text.find(path.string()), std::string::npos) << "the file is not named: " << text;
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
    EXPECT_FALSE(error.remedy().empty()) << text;
    EXPECT_EQ(error.fault(), Fault::input);
  }
}

TEST(ReadScan, EveryBrokenFileGetsOneClearError) {
  const TemporaryFolder folder;
  for (const Broken& broken : broken_ply()) expect_error(folder, broken);
  for (const Broken& broken : broken_others()) expect_error(folder, broken);
}

TEST(ReadScan, NoughtsFarFromAllOthersAreMissingReturns) {
  const TemporaryFolder folder;
  const Vector3d far(650000, 6860000, 30);
  std::vector<Vector3d> points = {Vector3d::Zero(), far, far + Vector3d(3, 0, 0), Vector3d::Zero(),
                                  far + Vector3d(0, 4, 2)};
  const ScanFile grid = read_scan_file(folder.write("grid.ply", simple_ply<double>(points, Writing::little)));
  EXPECT_EQ(grid.scans.front().size(), 3U);
  EXPECT_EQ(grid.unusable, 2U);
  for (Vector3d& x : points) x -= x.isZero(0.0) ? Vector3d::Zero() : far;
  EXPECT_EQ(read_scan(folder.write("near.ply", simple_ply<double>(points, Writing::little))).size(), 5U);
}

TEST(ReadScan, PathsThatAreNoFilesGetOneClearError) {
  const TemporaryFolder folder;
  for (const auto& path : {folder / "missing.ply", folder / "missing" / "x.ply", folder / ""}) {
    try {
      read_scan(path);
      ADD_FAILURE() << path;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(path.string()), std::string::npos);
      EXPECT_FALSE(error.remedy().empty());
    }
  }
}

TEST(ReadScan, AFileThatMayNotBeReadGetsOneClearError) {
  if (geteuid() == 0) GTEST_SKIP() << "root reads everything";
  const TemporaryFolder folder;
  const auto path = folder.write("secret.ply", "ply\n");
  chmod(path.c_str(), 0);
  EXPECT_THROW(read_scan(path), Error);
}

TEST(ReadScan, TellsTheFormatByContentWhateverTheEnding) {
  const TemporaryFolder folder;
  const auto points = room_points(100, 1);
  const std::string ply = simple_ply<double>(points, Writing::little);
  EXPECT_EQ(read_scan(folder.write("scan.dat", ply)).points, points);
  EXPECT_EQ(read_scan(folder.write("scan.pcd", ply)).points, points);
  EXPECT_EQ(read_scan_file(folder.write("pts", "1 2 3\n")).format, "XYZ text");
  const std::string ptx = kPtxHead + kIdentity + "1 2 3 0.5\n4 5 6 0.5\n";
  EXPECT_EQ(read_scan_file(folder.write("scan.txt", ptx)).format, "PTX");
  EXPECT_EQ(read_scan_file(folder.write("scan.txt", pcd("POINTS 1\n", "ascii") + "1 2 3\n")).format,
            "PCD, ascii");
}

TEST(ReadScan, EveryPrefixOfAFileIsReadOrRefused) {
  const TemporaryFolder folder;
  const std::string whole = simple_ply<float>(room_points(3, 2), Writing::big) + "tail";
  for (std::size_t size = 1; size < whole.size() - 4; ++size)
    EXPECT_THROW(read_scan(folder.write("part.ply", whole.substr(0, size))), Error) << size;
  EXPECT_EQ(read_scan(folder.write("part.ply", whole)).size(), 3U);
}

TEST(ReadScan, RandomDamageNeverCrashes) {
  const TemporaryFolder folder;
  const std::vector<std::string> seeds{
      simple_ply<float>(room_points(20, 3), Writing::little, "comment offset 1 2 3\n"),
      simple_ply<double>(room_points(20, 4), Writing::ascii),
      pcd("WIDTH 2\nHEIGHT 1\nPOINTS 2\n", "binary_compressed") + bytes_of(std::uint32_t{25}) +
          bytes_of(std::uint32_t{24}) + "\x17" + kTwelve + kTwelve,
      kPtxHead + kIdentity + "1 2 3 0.5\n4 5 6 0.5\n",
      "2\n1 2 3\n4 5 6\n",
      "x;y;z\n1;2;3\n"};
  RandomStream random(5);
  int read = 0;
  for (int trial = 0; trial < 800; ++trial) {
    std::string bytes = seeds[random.below(static_cast<std::uint32_t>(seeds.size()))];
    for (std::uint32_t k = 0; k <= random.below(4); ++k)
      bytes[random.below(static_cast<std::uint32_t>(bytes.size()))] = static_cast<char>(random.below(256));
    try {
      read_scan(folder.write("damaged", bytes)).check();
      ++read;
    } catch (const Error& error) {
      EXPECT_NE(error.fault(), Fault::internal) << error.what();
    }
  }
  EXPECT_GT(read, 50);
}

/// Bars a metre away, and a wall far behind them, a fifth of all points: thinned, most points lie on the
/// wall.
std::string behind_bars() {
  std::string text;
  int number = 0;
  for (double turn = -1.5; turn < 1.5; turn += 0.005) {
    for (double rise = -0.6; rise < 0.6; rise += 0.005) {
      const double range = number++ % 5 == 0 ? 4.0 : 1.0;
      text += fmt::format("{:.4f} {:.4f} {:.4f}\n", range * std::cos(turn) * std::cos(rise),
                          range * std::sin(turn) * std::cos(rise), range * std::sin(rise));
    }
  }
  return text;
}

TEST(ReadScan, ToThinACloudChangesNothingAboutItsScanner) {
  const TemporaryFolder folder;
  const auto file = folder.write("bars.xyz", behind_bars());
  ReadOptions options;
  EXPECT_EQ(read_scan(file, options).centre_source, PlaceSource::assumed);
  options.memory_bytes = 1000000;
  const Scan thinned = read_scan(file, options);
  EXPECT_LT(thinned.size(), 50000U);
  EXPECT_EQ(thinned.centre_source, PlaceSource::assumed);
}

/// Missing returns may come in a rhythm.
TEST(ReadScan, EveryFifthPointMayBeMissingInALargeCloud) {
  const TemporaryFolder folder;
  std::string text = "ply\nformat ascii 1.0\nelement vertex 1000000\n" + kXyzFloat + "end_header\n";
  for (int k = 0; k < 1000000; ++k)
    text += k % 5 == 0 ? std::string("nan nan nan\n")
                       : fmt::format("{} {} {}\n", k % 100, (k / 100) % 100, 1 + k / 10000);
  ReadOptions options;
  options.memory_bytes = 8000000;
  EXPECT_GT(read_scan(folder.write("gaps.ply", text), options).size(), 1000U);
}

}  // namespace
}  // namespace limen
