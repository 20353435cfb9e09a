// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/text/read_segments.h"

#include "support/test_support.h"
#include <gtest/gtest.h>

#include "limen/base/error.h"

namespace limen {
namespace {

using testing_io::TemporaryFolder;

Vector3d world(const SegmentSet& set, const Vector3d& x) {
  return set.local_origin + x;
}

std::string error_of(const std::filesystem::path& path) {
  try {
    (void)read_segments(path);
  } catch (const Error& error) {
    return error.problem() + " | " + error.where();
  }
  return "no error";
}

TEST(ReadSegments, JsonOfSegments) {
  const TemporaryFolder folder;
  const auto path = folder.write(
      "a.json",
      R"({"segments": [{"a": [1050000.125, 6840000.5, 1], "b": [1050002.125, 6840000.5, 1], "x": 2}]})");
  EXPECT_TRUE(is_segment_file(path));
  const SegmentSet set = read_segments(path);
  ASSERT_EQ(set.segments.size(), 1U);
  EXPECT_EQ(set.local_origin, Vector3d(1050001, 6840001, 1));
  EXPECT_EQ(world(set, set.segments[0].a), Vector3d(1050000.125, 6840000.5, 1));
  EXPECT_DOUBLE_EQ(set.segments[0].length(), 2.0);
}

TEST(ReadSegments, SidesOfOpeningsThatWereSeen) {
  const TemporaryFolder folder;
  const auto path = folder.write("o.json", R"({"planes": [], "openings": [
    {"corners": [[0,0,0],[1,0,0],[1,0,2],[0,0,2]], "edge_sigma_m": [0.01, 1.0, 0.02, 0.01]}]})");
  EXPECT_TRUE(is_segment_file(path));
  const SegmentSet set = read_segments(path);
  ASSERT_EQ(set.segments.size(), 3U);
  EXPECT_EQ(world(set, set.segments[0].b), Vector3d(1, 0, 0));
  EXPECT_EQ(world(set, set.segments[1].a), Vector3d(1, 0, 2));  // the right side was not seen
}

TEST(ReadSegments, LettersAsThePapersAuthorsWriteThem) {
  const TemporaryFolder folder;
  const auto path = folder.write("w.txt",
                                 "p  0.3 0.9 0.002 -97.8  0 \n   O  0 0 \n"
                                 "L 1 2   3 4 2 3 V 0 0 \r\nL  1   2 3 1 2 9 H 0 0 \nO 1 0\n");
  EXPECT_TRUE(is_segment_file(path));
  const SegmentSet set = read_segments(path);
  ASSERT_EQ(set.segments.size(), 2U);
  EXPECT_EQ(world(set, set.segments[1].b), Vector3d(1, 2, 9));
}

TEST(ReadSegments, LinesFromPhotographs) {
  const TemporaryFolder folder;
  const auto path = folder.write("l.txt",
                                 "1 0 0 0 1 0 0 1 4 34 1 2 3 4\n"
                                 "2 0 0 0 0 1 0 0 2 0 0 3 0 1 4 34 1 2 3 4\n");
  EXPECT_TRUE(is_segment_file(path));
  EXPECT_EQ(read_segments(path).segments.size(), 3U);
}

TEST(ReadSegments, OtherFilesAreNone) {
  const TemporaryFolder folder;
  EXPECT_FALSE(is_segment_file(folder.write("cloud.xyz", "1 2 3 4 5 6\n1 2 3 4 5 6\n")));
  EXPECT_FALSE(is_segment_file(folder.write("result.json", R"({"outcome": "registered"})")));
  EXPECT_FALSE(is_segment_file(folder.write("cloud.ply", "ply\nformat ascii 1.0\n")));
  EXPECT_FALSE(is_segment_file(folder.write("model.obj", "o house\nv 0 0 0\n")));
  EXPECT_FALSE(is_segment_file(folder.write("empty", "")));
  EXPECT_FALSE(is_segment_file(folder / "missing"));
  EXPECT_EQ(error_of(folder / "cloud.xyz"),
            "holds no segments that limen can read | " + (folder / "cloud.xyz").string());
}

TEST(ReadSegments, FaultsAreNamedWithTheirLine) {
  const TemporaryFolder folder;
  const auto error = [&](const std::string& text) { return error_of(folder.write("bad", text)); };
  const std::string file = (folder / "bad").string();
  const std::string start = "p 0 0 1 2 0\nO 0 0\nL 0 0 0 1 1 1 V\n";
  EXPECT_EQ(error(start + "\nL 0 0 0 1 x 1 V\n"), "\"x\" is not a number | " + file + ", line 5");
  EXPECT_EQ(error(start + "L 0 0 nan 1 0 1 V\n"), "\"nan\" is not a number | " + file + ", line 4");
  EXPECT_EQ(error(start + "L 0 0 0\n"), "the line must have 6 numbers, but has 3 | " + file + ", line 4");
  EXPECT_EQ(error(start + "Q 0 0 0\n"), "\"Q\" is not p, O or L | " + file + ", line 4");
  EXPECT_EQ(error("p 0 0 1 2 0\nO 0 0\n"), "holds no segment | " + file);
  EXPECT_EQ(error("{\n\"segments\": [\n{\"a\": [1,2,}]}"), "is not JSON | " + file + ", line 3");
  EXPECT_EQ(error(R"({"segments": [{"a": [1,2,3]}]})"), "has no ends a and b | " + file + ": segments[0]");
  EXPECT_EQ(error(R"({"segments": [{"a": [1,2,3], "b": [1,2,"3"]}]})"),
            "is not a point of three numbers | " + file + ": segments[0].b");
  EXPECT_EQ(error(R"({"openings": [{"corners": [[1,2,3]]}]})"),
            "has no four corners | " + file + ": openings[0]");
  EXPECT_EQ(error(R"({"segments": 1e999})"), "has a number that is too large | " + file);
  EXPECT_EQ(error(R"({"segments": []})"), "holds no segment | " + file);
  EXPECT_EQ(error(R"({"segments": 7})"), "segments is not a list | " + file);
  EXPECT_EQ(error("1 0 0 0 1 0 0 1 4 34 1 2 3 4\n1 0 0 0 1 0 0 1 4 34 1 2 3 4\n1 0 0 0 1 0 0 1 4 34 1 2 3 "
                  "4\n2 0 0 0 0 1 0\n"),
            "the line must have 12 numbers, but has 6 | " + file + ", line 4");
}

}  // namespace
}  // namespace limen
