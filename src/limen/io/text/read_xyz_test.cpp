// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "support/test_support.h"
#include <gtest/gtest.h>

#include "limen/base/error.h"
#include "limen/io/text/text.h"

namespace limen {
namespace {

struct Case {
  const char* what;
  const char* text;
  std::vector<Vector3d> points;
};

const Case kCases[] = {
    {"blanks", "1 2 3\n4 5 6\n", {{1, 2, 3}, {4, 5, 6}}},
    {"tabs, no last newline", "1\t2\t3\n4\t5\t6", {{1, 2, 3}, {4, 5, 6}}},
    {"comma and blank", "1, 2, 3\n4 , 5 , 6\n", {{1, 2, 3}, {4, 5, 6}}},
    {"semicolons", "1.5;2;3\n4;5;6\n", {{1.5, 2, 3}, {4, 5, 6}}},
    {"windows", "1 2 3\r\n\r\n4 5 6\r\n", {{1, 2, 3}, {4, 5, 6}}},
    {"comments", "# made by hand\n// more\n1 2 3\n% between\n4 5 6\n", {{1, 2, 3}, {4, 5, 6}}},
    {"names", "X,Y,Z\n1,2,3\n", {{1, 2, 3}}},
    {"names in another order", "\"Z\";\"intensity\";\"X\";\"Y\"\n3;9;1;2\n", {{1, 2, 3}}},
    {"names in a comment, units", "//X[m] Y[m] Z[m] R G B\n1 2 3 9 8 7\n", {{1, 2, 3}}},
    {"a comment with the words before the names", "// crs X Y Z OTHER\n// z x y\n3 1 2\n", {{1, 2, 3}}},
    {"a comment with the words behind the names", "z x y\n# x y and z in metres\n3 1 2\n", {{1, 2, 3}}},
    {"byte order mark", "\xEF\xBB\xBFx y z\n1 2 3\n", {{1, 2, 3}}},
    {"count line", "2\n1 2 3 -1000 9 8 7\n4 5 6 -1000 9 8 7\n", {{1, 2, 3}, {4, 5, 6}}},
    {"two counted blocks", "1\n1 2 3\n1\n4 5 6\n", {{1, 2, 3}, {4, 5, 6}}},
    {"exponents and plus signs", "+1 2e0 3.0E+0\n", {{1, 2, 3}}},
    {"words behind the numbers", "1 2 3 wall\n4 5 6 floor\n", {{1, 2, 3}, {4, 5, 6}}},
};

TEST(ReadXyz, ReadsWhatPeopleCallText) {
  for (const Case& c : kCases) {
    EXPECT_TRUE(looks_like_xyz(c.text)) << c.what;
    const ScanFile file = read_xyz(c.text, "t.xyz");
    EXPECT_EQ(file.scans.at(0).points, c.points) << c.what;
  }
}

TEST(ReadXyz, ColumnsWithoutNamesFindTheirMeaning) {
  const Scan four = read_xyz("1 2 3 0.5\n", "t").scans.at(0);
  EXPECT_EQ(four.intensities, std::vector<float>{0.5F});
  const Scan colours = read_xyz("1 2 3 255 0 9\n", "t").scans.at(0);
  EXPECT_EQ(colours.colours, (std::vector<std::uint8_t>{255, 0, 9}));
  const Scan normals = read_xyz("1 2 3 0 0 1\n1 2 3 0 1 0\n", "t").scans.at(0);
  EXPECT_TRUE(normals.colours.empty());
  const Scan seven = read_xyz("1 2 3 -5 10 20 30\n", "t").scans.at(0);
  EXPECT_EQ(seven.intensities, std::vector<float>{-5.0F});
  EXPECT_EQ(seven.colours, (std::vector<std::uint8_t>{10, 20, 30}));
}

TEST(ReadXyz, ACommentStatesTheScannersPosition) {
  const Scan stated = read_xyz("// scanner_position 1.5 2 -3\n// x y z\n1 2 3\n4 5 6\n", "t").scans.at(0);
  ASSERT_TRUE(stated.centre_known());
  EXPECT_EQ(Vector3d(stated.local_origin + stated.centres[0]), Vector3d(1.5, 2, -3));
  EXPECT_EQ(stated.centre_source, PlaceSource::stated_by_file);
  for (const char* line :
       {"// scanner_position 1.5 2\n", "// scanner_position 1 2 three\n", "// scanner 1 2 3\n"})
    EXPECT_FALSE(scanner_position_in(line)) << line;
}

TEST(ReadXyz, NumbersWithoutANameAreSaidToBeUnused) {
  const ScanFile file = read_xyz("x y z\n1 2 3 4 5\n", "t");
  EXPECT_EQ(file.scans.at(0).points, std::vector<Vector3d>{Vector3d(1, 2, 3)});
  EXPECT_EQ(file.notes.at(0), "its rows have 5 numbers, but 3 columns have names: the rest is unused");
  EXPECT_TRUE(read_xyz("x y z\n1 2 3\n", "t").notes.empty() ||
              read_xyz("x y z\n1 2 3\n", "t").notes.at(0).find("unused") == std::string::npos);
}

TEST(ReadXyz, AMobileScanMayBeATable) {
  const Scan scan =
      read_xyz("x,y,z,x_origin,y_origin,z_origin,GpsTime\n1,2,3,0,0,2,7.5\n4,5,6,1,0,2,7.75\n", "t")
          .scans.at(0);
  ASSERT_TRUE(scan.mobile());
  EXPECT_EQ(scan.centre(1), Vector3d(1, 0, 2));
  EXPECT_EQ(scan.times_s, (std::vector<double>{7.5, 7.75}));
}

TEST(ReadXyz, ScannerPositionsInAnotherFrameAreRefused) {
  const std::string text =
      "x y z x_origin y_origin z_origin\n500000 5400000 3 0 0 1\n500001 5400000 3 1 0 1\n";
  try {
    (void)read_xyz(text, "t");
    ADD_FAILURE() << "it was read";
  } catch (const Error& error) {
    EXPECT_NE(error.problem().find("5423 km away"), std::string::npos) << error.problem();
  }
}

TEST(ReadXyz, KeepsNationalGridDigitsOverManyPieces) {
  const auto points = testing_io::random_points(80000, {1050000.1234, 6840000.5678, 100.0}, 40.0, 1);
  std::string text;
  for (const Vector3d& p : points) text += fmt::format("{:.6f} {:.6f} {:.6f}\n", p.x(), p.y(), p.z());
  const Scan scan = read_xyz(text, "t").scans.at(0);
  ASSERT_EQ(scan.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    ASSERT_LT((scan.local_origin + scan.points[i] - points[i]).cwiseAbs().maxCoeff(), 0.51e-6);
}

TEST(ReadXyz, TellsWhereTheCountIsWrong) {
  EXPECT_THROW(read_xyz("3\n1 2 3\n4 5 6\n", "t.pts"), Error);
  const ScanFile more = read_xyz("1\n1 2 3\n4 5 6\n", "t.pts");
  EXPECT_EQ(more.scans.at(0).size(), 2U);
  EXPECT_NE(more.notes.front().find("count says 1"), std::string::npos);
}

TEST(ReadXyz, DecimalCommasBesideWholeNumbersAreRefused) {
  for (const std::string text : {"1,5;2,25;3,125", "1050003,351;6840002,458;28,500;200;180;170", "0;2,14;1",
                                 "0,000 1,149 -0,867 200 180 170", "1,5\t2\t3\t-1200"})
    EXPECT_THROW(read_xyz(text + "\n" + text + "\n", "t.csv"), Error) << text;
  for (const std::string text : {"1;2;3", "1,2,3", "1.5,2.5,3.5", "1, 2, 3", "1.5;2;3"})
    EXPECT_NO_THROW(read_xyz(text + "\n" + text + "\n", "t.csv")) << text;
}

TEST(ReadXyz, NamesTheLineOfABadRow) {
  std::string text;
  for (int i = 0; i < 200000; ++i) text += i == 150000 ? "1 2\n" : "1.5 2.5 3.5\n";
  try {
    read_xyz(text, "t.xyz");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.where(), "t.xyz, line 150001");
  }
}

TEST(ReadXyz, ARowOfAbsurdlyManyNumbersIsRefused) {
  const auto row = [](int columns) {
    std::string text;
    for (int k = 0; k < columns; ++k) text += "1 ";
    return text + "\n2 3 4" + text + "\n";
  };
  EXPECT_NO_THROW(read_xyz(row(1000), "t.xyz"));
  EXPECT_THROW(read_xyz(row(1001), "t.xyz"), Error);
}

}  // namespace
}  // namespace limen
