// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <limits>

#include "support/synthetic_las.h"
#include <gtest/gtest.h>

#include "limen/base/error.h"
#include "limen/io/las/las.h"

namespace limen {
namespace {

using namespace testing_las;

/// What the error says, or "no error".
std::string las_error_of(const std::string& bytes) {
  try {
    records_of(bytes);
    open_las(bytes, "test");
  } catch (const Error& error) {
    return error.problem();
  }
  return "no error";
}

Parts some(int minor, int format, std::size_t count = 50) {
  Parts parts;
  parts.minor = minor;
  parts.format = format;
  parts.points = random_points(format, 0, count, 7);
  return parts;
}

TEST(ReadLas, EveryFormatGivesItsColumns) {
  for (int format = 0; format <= 10; ++format) {
    const Parts parts = some(format < 4 ? 2 : 4, format);
    const std::string bytes = file(parts);
    const auto opened = open_las(bytes, "test");
    const auto& fields = opened->clouds()[0].fields;
    const auto has = [&](const char* name) {
      return std::find(fields.begin(), fields.end(), name) != fields.end();
    };
    EXPECT_EQ(opened->clouds()[0].points, 50U);
    EXPECT_EQ(has("gps_time"), format != 0 && format != 2) << format;
    EXPECT_EQ(has("red"),
              format == 2 || format == 3 || format == 5 || format == 7 || format == 8 || format == 10);
    EXPECT_EQ(has("nir"), format == 8 || format == 10);
    EXPECT_EQ(has("wave_packet_index"), format == 4 || format == 5 || format == 9 || format == 10);
    EXPECT_EQ(has("overlap"), format >= 6);
    EXPECT_FALSE(opened->clouds()[0].table.centre_unknown);
    EXPECT_EQ(records_of(bytes, 7), parts.points);
  }
}

TEST(ReadLas, ValuesOfOnePointOfFormat3) {
  std::string point(34, '\0');
  put(point, 0, std::int32_t{-1500});
  put(point, 4, std::int32_t{2500});
  put(point, 8, std::int32_t{300});
  put(point, 12, std::uint16_t{4660});
  point[14] = static_cast<char>(0b10'011'010);  // return 2 of 3, edge of flight line
  point[15] = static_cast<char>(0b101'00110);   // class 6, synthetic, withheld
  point[16] = static_cast<char>(-12);
  point[17] = 9;
  put(point, 18, std::uint16_t{77});
  put(point, 20, 123456.789);
  put(point, 28, std::uint16_t{1});
  put(point, 30, std::uint16_t{2});
  put(point, 32, std::uint16_t{65535});
  Parts parts = some(2, 3);
  parts.points = point;
  const std::string bytes = file(parts);
  const auto value = [&](const char* name) { return column(bytes, name).at(0); };
  EXPECT_DOUBLE_EQ(value("x"), 500000.0 - 1.5);
  EXPECT_DOUBLE_EQ(value("y"), 5400000.0 + 2.5);
  EXPECT_DOUBLE_EQ(value("z"), 103.0);
  EXPECT_EQ(value("intensity"), 4660.0);
  EXPECT_EQ(value("return_number"), 2.0);
  EXPECT_EQ(value("number_of_returns"), 3.0);
  EXPECT_EQ(value("scan_direction_flag"), 0.0);
  EXPECT_EQ(value("edge_of_flight_line"), 1.0);
  EXPECT_EQ(value("classification"), 6.0);
  EXPECT_EQ(value("synthetic"), 1.0);
  EXPECT_EQ(value("key_point"), 0.0);
  EXPECT_EQ(value("withheld"), 1.0);
  EXPECT_EQ(value("scan_angle"), -12.0);
  EXPECT_EQ(value("user_data"), 9.0);
  EXPECT_EQ(value("point_source_id"), 77.0);
  EXPECT_EQ(value("gps_time"), 123456.789);
  EXPECT_EQ(value("blue"), 65535.0);
  const auto opened = open_las(bytes, "test");
  const auto& notes = opened->clouds()[0].notes;
  EXPECT_NE(std::find(notes.begin(), notes.end(), "points that the file marks as withheld are kept"),
            notes.end());
}

TEST(ReadLas, ValuesOfOnePointOfFormat6) {
  std::string point(30, '\0');
  point[14] = 0x52;                             // return 2 of 5
  point[15] = static_cast<char>(0b01'10'1010);  // key point, overlap, channel 2, direction
  point[16] = static_cast<char>(200);
  put(point, 18, std::int16_t{-5000});
  put(point, 20, std::uint16_t{60000});
  Parts parts = some(4, 6);
  parts.points = point;
  const std::string bytes = file(parts);
  const auto value = [&](const char* name) { return column(bytes, name).at(0); };
  EXPECT_EQ(value("return_number"), 2.0);
  EXPECT_EQ(value("number_of_returns"), 5.0);
  EXPECT_EQ(value("classification"), 200.0);
  EXPECT_EQ(value("synthetic"), 0.0);
  EXPECT_EQ(value("key_point"), 1.0);
  EXPECT_EQ(value("withheld"), 0.0);
  EXPECT_EQ(value("overlap"), 1.0);
  EXPECT_EQ(value("scanner_channel"), 2.0);
  EXPECT_EQ(value("scan_direction_flag"), 1.0);
  EXPECT_EQ(value("edge_of_flight_line"), 0.0);
  EXPECT_DOUBLE_EQ(value("scan_angle"), -30.0);
  EXPECT_EQ(value("point_source_id"), 60000.0);
}

/// A description of extra bytes.
std::string extra(const std::string& name, char type, char options, double scale = 0.0, double offset = 0.0) {
  std::string about(192, '\0');
  about[2] = type;
  about[3] = options;
  about.replace(4, name.size(), name);
  put(about, 112, scale);
  put(about, 136, offset);
  return about;
}

TEST(ReadLas, ExtraBytesHaveNamesTypesScales) {
  Parts parts = some(4, 6);
  parts.extra = 4 + 2 + 1 + 2;
  parts.points = std::string(point_bytes(parts), '\0');
  put(parts.points, 30, 2.5F);
  put(parts.points, 34, std::int16_t{-100});
  parts.points[36] = 17;
  parts.points[37] = 18;
  parts.points[38] = 19;
  parts.records.push_back(
      record("LASF_Spec", 4,
             extra("Deviation", 9, 0) + extra("Echo width", 4, 24, 0.1, 5.0) + extra("intensity", 1, 0)));
  const std::string bytes = file(parts);
  EXPECT_EQ(column(bytes, "deviation").at(0), 2.5);
  EXPECT_DOUBLE_EQ(column(bytes, "echo_width").at(0), -5.0);
  EXPECT_EQ(column(bytes, "intensity").at(0), 17.0);
  EXPECT_EQ(column(bytes, "las_intensity").at(0), 0.0);
  EXPECT_EQ(column(bytes, "extra_bytes_1").at(0), 18.0);
  EXPECT_EQ(column(bytes, "extra_bytes_2").at(0), 19.0);
}

TEST(ReadLas, ExtraBytesBeyondTheRecordAreStated) {
  Parts parts = some(4, 6);
  parts.records.push_back(record("LASF_Spec", 4, extra("too much", 10, 0)));
  const std::string bytes = file(parts);
  const auto opened = open_las(bytes, "test");
  EXPECT_EQ(opened->clouds()[0].notes.at(0),
            "1 extra values per point are described, but only 0 are present");
}

TEST(ReadLas, ManyUndescribedBytesAreStatedNotGiven) {
  Parts parts = some(4, 6);
  parts.extra = 60000;
  parts.points = std::string(point_bytes(parts), '\0');
  const std::string bytes = file(parts);
  const auto opened = open_las(bytes, "test");
  EXPECT_LT(opened->clouds()[0].fields.size(), 100U);
  EXPECT_EQ(opened->clouds()[0].notes.at(0),
            "60000 bytes per point are not described by the header, and not all of them are read as values");
}

TEST(ReadLas, TimesAreStated) {
  Parts parts = some(2, 1);
  std::string bytes = file(parts);
  EXPECT_NE(open_las(bytes, "test")->clouds()[0].notes.at(0).find("GPS week"), std::string::npos);
  bytes[6] = 1;
  EXPECT_NE(open_las(bytes, "test")->clouds()[0].notes.at(0).find("adjusted standard"), std::string::npos);
}

TEST(ReadLas, CoordinateSystemsAreFound) {
  Parts parts = some(4, 6);
  parts.records.push_back(record("LASF_Projection", 2112, std::string("PROJCS[\"x\"]") + '\0'));
  EXPECT_EQ(las_coordinate_systems(parse_las_header(file(parts), "test")),
            std::vector<std::string>{"PROJCS[\"x\"]"});
}

TEST(ReadLas, PromisesThatCannotBeKept) {
  const std::string whole = file(some(2, 1));
  EXPECT_EQ(las_error_of(whole.substr(0, whole.size() - 1)),
            "the header promises 50 points, the file has room for 49");
  EXPECT_EQ(las_error_of(whole.substr(0, 100)), "the file ends within its header, after 100 bytes");
  const auto changed = [&](std::size_t at, auto value) {
    std::string bytes = whole;
    put(bytes, at, value);
    return las_error_of(bytes);
  };
  EXPECT_EQ(changed(24, std::uint8_t{2}), "LAS version 2.2 is not known");
  EXPECT_EQ(changed(25, std::uint8_t{5}), "LAS version 1.5 is not known");
  EXPECT_EQ(changed(94, std::uint16_t{100}), "a header of 100 bytes is impossible: LAS 1.2 has 227");
  EXPECT_EQ(changed(96, std::uint32_t{100}).substr(0, 37), "the points should begin at byte 100, ");
  EXPECT_EQ(changed(96, std::uint32_t{0x7FFFFFFF}).substr(0, 27), "the points should begin at ");
  EXPECT_EQ(changed(104, std::uint8_t{11}), "point format 11 is not known");
  EXPECT_EQ(changed(105, std::uint16_t{27}), "points of 27 bytes are impossible: point format 1 has 28");
  EXPECT_EQ(changed(131, 0.0), "a scale of 0 with an offset of 500000 is impossible");
  EXPECT_EQ(changed(155, std::numeric_limits<double>::quiet_NaN()),
            "a scale of 0.001 with an offset of nan is impossible");
  EXPECT_EQ(changed(104, std::uint8_t{0x81}), "the points are compressed, but no LASzip record says how");
  EXPECT_EQ(changed(179, std::numeric_limits<double>::quiet_NaN()), "no error");  // a box is not needed
}

TEST(ReadLas, RecordsThatDoNotFitArePassedOver) {
  std::string bytes = file(some(2, 1));
  put(bytes, 100, std::uint32_t{3000000000U});
  const auto opened = open_las(bytes, "test");
  EXPECT_NE(
      opened->clouds()[0].notes.at(0).find("promises 3000000000 variable length records, but only 0 fit"),
      std::string::npos);
  EXPECT_EQ(column(bytes, "x").size(), 50U);
}

TEST(ReadLas, TwoCounts) {
  std::string bytes = file(some(4, 6));
  put(bytes, 107, std::uint32_t{49});
  EXPECT_EQ(open_las(bytes, "test")->clouds()[0].points, 50U);
  EXPECT_NE(open_las(bytes, "test")->clouds()[0].notes.at(0).find("disagree"), std::string::npos);
  put(bytes, 247, std::uint64_t{1} << 60U);
  EXPECT_EQ(las_error_of(bytes).substr(0, 20), "the header promises ");
}

TEST(ReadLas, AnyShortenedOrChangedFileIsReadOrRefused) {
  Parts parts = some(4, 7, 5);
  parts.records.push_back(record("LASF_Spec", 4, extra("a", 9, 0)));
  parts.tail = long_record("limen", 9, "text");
  parts.tail_records = 1;
  const std::string whole = file(parts);
  for (std::size_t length = 0; length < whole.size(); length += 3)
    (void)las_error_of(whole.substr(0, length));
  RandomStream random(3);
  int refused = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    std::string bytes = whole;
    for (std::uint32_t k = random.below(4) + 1; k > 0; --k)
      bytes[random.below(static_cast<std::uint32_t>(bytes.size()))] = static_cast<char>(random.below(256));
    refused += las_error_of(bytes) == "no error" ? 0 : 1;
  }
  EXPECT_GT(refused, 100);
  EXPECT_LT(refused, 2900);
}

}  // namespace
}  // namespace limen
