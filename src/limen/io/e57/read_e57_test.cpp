// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include "support/synthetic_e57.h"
#include <gtest/gtest.h>

#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/io/e57/e57.h"
#include "limen/io/e57/e57_document.h"

namespace limen {
namespace {

using namespace testing_e57;

std::vector<double> ramp(std::size_t count, double from, double step) {
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) values.push_back(from + step * static_cast<double>(i));
  return values;
}

/// x, y, z as doubles and what more is wanted.
ScanParts simple_scan(std::size_t count, std::vector<Column> more = {}) {
  ScanParts scan;
  scan.points = count;
  scan.columns = {float_column("cartesianX", ramp(count, 1.0, 0.5)),
                  float_column("cartesianY", ramp(count, -3.0, 0.25)),
                  float_column("cartesianZ", ramp(count, 0.0, 0.125))};
  for (Column& column : more) scan.columns.push_back(std::move(column));
  return scan;
}

const Field& field(const RecordTable& table, const char* name) {
  const Field* found = table.find({name});
  if (found == nullptr) throw std::runtime_error(std::string("no field ") + name);
  return *found;
}

std::vector<double> e57_column(const std::string& bytes, const std::string& name, std::size_t cloud = 0) {
  const auto file = open_e57(bytes, "test.e57");
  const auto& fields = file->clouds()[cloud].fields;
  const auto at = std::find(fields.begin(), fields.end(), name);
  if (at == fields.end()) throw std::runtime_error("no field " + name);
  return read_all(*file, cloud)[static_cast<std::size_t>(at - fields.begin())];
}

std::string message_of(const std::string& bytes) {
  try {
    const auto file = open_e57(bytes, "test.e57");
    for (std::size_t k = 0; k < file->clouds().size(); ++k) (void)read_all(*file, k);
  } catch (const Error& error) {
    EXPECT_FALSE(error.where().empty());
    EXPECT_FALSE(error.remedy().empty());
    return error.what();
  }
  return {};
}

TEST(ReadE57, LooksLikeE57) {
  EXPECT_TRUE(looks_like_e57("ASTM-E57 and more"));
  EXPECT_FALSE(looks_like_e57("ASTM-E5"));
  EXPECT_FALSE(looks_like_e57(""));
}

TEST(ReadE57, EveryWidthComesBack) {
  for (unsigned width = 0; width <= 64; ++width) {
    RandomStream random(100 + width);
    const std::int64_t minimum = width == 64   ? INT64_MIN
                                 : width == 63 ? -5000
                                               : -1234567 + static_cast<int>(width);
    const std::uint64_t mask = width == 0 ? 0 : ~std::uint64_t{0} >> (64 - width);
    std::vector<std::int64_t> values;
    for (int i = 0; i < 1503; ++i) {
      const std::uint64_t raw = ((std::uint64_t{random.next()} << 32U) | random.next()) & mask;
      values.push_back(static_cast<std::int64_t>(static_cast<std::uint64_t>(minimum) + raw));
    }
    Layout layout;
    layout.packet_seed = 7 + width;
    const std::string bytes =
        file_of({simple_scan(values.size(), {integer_column("limen:n", minimum, width, values)})}, layout);
    const auto file = open_e57(bytes, "test.e57");
    const auto stream = file->read(0);
    std::size_t row = 0;
    while (const auto table = stream->next(401)) {
      const Field& n = field(*table, "n");
      EXPECT_TRUE(is_integer(n.type)) << width;
      for (std::size_t i = 0; i < table->rows; ++i, ++row) {
        if (width > 53) {  // a double would not hold them
          ASSERT_EQ(n.type, Scalar::int64);
          std::int64_t value = 0;
          std::memcpy(&value, n.data + i * n.stride, sizeof value);
          ASSERT_EQ(value, values[row]) << width;
        } else {
          double value = 0.0;
          load_numbers(*table, n, {i, i + 1}, &value);
          ASSERT_EQ(value, static_cast<double>(values[row])) << width;
        }
      }
    }
    EXPECT_EQ(row, values.size()) << width;
  }
}

TEST(ReadE57, PiecesPagesAndPacketsDoNotMatter) {
  const std::size_t count = 5000;
  std::vector<std::int64_t> numbers;
  for (std::size_t i = 0; i < count; ++i) numbers.push_back(static_cast<std::int64_t>(i * i % 8191) - 4096);
  const ScanParts scan = simple_scan(count, {integer_column("limen:a", -4096, 13, numbers),
                                             float_column("limen:b", ramp(count, 5.0, 1.0), true)});
  const auto expected = read_all(*open_e57(file_of({scan}), "test.e57"));
  ASSERT_EQ(expected.size(), 5U);
  ASSERT_EQ(expected[3].size(), count);
  for (std::size_t i = 0; i < count; ++i) {
    ASSERT_EQ(expected[0][i], 1.0 + 0.5 * static_cast<double>(i));
    ASSERT_EQ(expected[3][i], static_cast<double>(numbers[i]));
    ASSERT_EQ(expected[4][i], 5.0 + static_cast<double>(i));
  }
  for (const std::size_t page_bytes : {64UL, 1024UL, 4096UL}) {
    for (const std::uint64_t seed : {0UL, 1UL, 2UL}) {
      Layout layout;
      layout.page_bytes = page_bytes;
      layout.packet_seed = seed;
      layout.packet_bytes = seed == 2 ? 11 : 3000;
      const std::string bytes = file_of({scan}, layout);
      for (const std::size_t most : {1UL, 7UL, 4999UL, 100000UL}) {
        if (most == 1 && page_bytes != 64) continue;
        EXPECT_EQ(read_all(*open_e57(bytes, "test.e57"), 0, most), expected);
      }
    }
  }
}

TEST(ReadE57, ThreadsDoNotMatter) {
  const std::size_t count = 200000;
  const std::string bytes = file_of({simple_scan(count)});
  set_thread_count(1);
  const auto one = read_all(*open_e57(bytes, "test.e57"), 0, count);
  set_thread_count(3);
  const auto three = read_all(*open_e57(bytes, "test.e57"), 0, count);
  set_thread_count(0);
  EXPECT_EQ(one, three);
  EXPECT_EQ(one[2].back(), 0.125 * static_cast<double>(count - 1));
}

TEST(ReadE57, ScaledIntegers) {
  ScanParts scan;
  scan.points = 4;
  scan.columns = {
      integer_column("cartesianX", -100, 12, {-100, 0, 5, 3995}, " scale=\"0.001\" offset=\"7e3\""),
      integer_column("cartesianY", 0, 3, {0, 1, 2, 7}, " scale=\"0.5\""),
      integer_column("cartesianZ", 9, 0, {9, 9, 9, 9}, " scale=\"0.25\"")};
  const auto columns = read_all(*open_e57(file_of({scan}), "test.e57"));
  EXPECT_EQ(columns[0], (std::vector<double>{7e3 - 0.1, 7e3, 7e3 + 0.005, 7e3 + 3.995}));
  EXPECT_EQ(columns[1], (std::vector<double>{0.0, 0.5, 1.0, 3.5}));
  EXPECT_EQ(columns[2], (std::vector<double>{2.25, 2.25, 2.25, 2.25}));
}

TEST(ReadE57, InvalidPointsAreNotNumbers) {
  const std::vector<std::int64_t> state{0, 1, 2, 0};
  const auto invalid = integer_column("cartesianInvalidState", 0, 2, state);
  ScanParts integers;
  integers.points = 4;
  integers.columns = {integer_column("cartesianX", -100, 12, {-100, 0, 5, 3995}, " scale=\"0.5\""),
                      float_column("cartesianY", {1, 2, 3, 4}),
                      float_column("cartesianZ", {1, 2, 3, 4}, true), invalid,
                      float_column("intensity", {5, 6, 7, 8})};
  const std::string bytes = file_of({integers});
  const auto file = open_e57(bytes, "test.e57");
  EXPECT_EQ(file->clouds()[0].fields, (std::vector<std::string>{"x", "y", "z", "intensity"}));
  const auto columns = read_all(*file);
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(std::isnan(columns[k][i]), state[i] != 0);
  }
  EXPECT_EQ(columns[0][3], 0.5 * 3995);
  EXPECT_EQ(columns[3], (std::vector<double>{5, 6, 7, 8}));
}

TEST(ReadE57, SphericalCoordinatesBecomeCartesian) {
  const double quarter = std::numbers::pi / 2;
  ScanParts scan;
  scan.points = 5;
  scan.columns = {float_column("sphericalRange", {1, 2, 3, 4, 5}),
                  float_column("sphericalAzimuth", {0, quarter, 0, 2 * quarter, 1}),
                  float_column("sphericalElevation", {0, 0, quarter, 0.5, 1}),
                  integer_column("sphericalInvalidState", 0, 1, {0, 0, 0, 0, 1})};
  const std::string bytes = file_of({scan});
  const auto file = open_e57(bytes, "test.e57");
  EXPECT_TRUE(file->clouds()[0].table.centre.has_value());
  const auto columns = read_all(*file);
  ASSERT_EQ(columns.size(), 3U);
  const std::vector<Vector3d> expected{
      {1, 0, 0}, {0, 2, 0}, {0, 0, 3}, {-4 * std::cos(0.5), 0, 4 * std::sin(0.5)}};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(columns[k][i], expected[i][static_cast<int>(k)], 1e-15);
  }
  for (std::size_t k = 0; k < 3; ++k) EXPECT_TRUE(std::isnan(columns[k][4]));
}

TEST(ReadE57, ColoursAreBroughtToEightOrSixteenBits) {
  const auto colour = [&](const std::string& limits, Column red) {
    ScanParts scan = simple_scan(3, {std::move(red)});
    if (!limits.empty())
      scan.before_points =
          "<colorLimits type=\"Structure\"><colorRedMinimum type=\"Integer\"/><colorRedMaximum "
          "type=\"Integer\">" +
          limits + "</colorRedMaximum></colorLimits>";
    return e57_column(file_of({scan}), "red");
  };
  using Values = std::vector<double>;
  EXPECT_EQ(colour("255", integer_column("colorRed", 0, 8, {0, 7, 255})), (Values{0, 7, 255}));
  EXPECT_EQ(colour("65535", integer_column("colorRed", 0, 16, {0, 7, 65535})), (Values{0, 7, 65535}));
  EXPECT_EQ(colour("", integer_column("colorRed", 0, 16, {0, 7, 65535})), (Values{0, 7, 65535}));
  EXPECT_NEAR(colour("1023", integer_column("colorRed", 0, 10, {0, 7, 1023}))[2], 65535, 1e-9);
  EXPECT_NEAR(colour("", integer_column("colorRed", 0, 5, {0, 7, 31}))[2], 255, 1e-9);
  EXPECT_EQ(colour("1", float_column("colorRed", {0, 0.2, 1}, true))[2], 255);
  EXPECT_EQ(colour("240", integer_column("colorRed", 0, 8, {0, 7, 240})), (Values{0, 7, 240}));
}

TEST(ReadE57, TimesRowsColumnsNormalsAndExtensions) {
  ScanParts scan =
      simple_scan(2, {float_column("timeStamp", {0.5, 1.5}), integer_column("rowIndex", 0, 4, {3, 9}),
                      integer_column("columnIndex", 0, 4, {1, 2}), float_column("nor:normalX", {1, 0}),
                      integer_column("las:pointSourceId", 0, 16, {77, 78}),
                      integer_column("limen:GPS_x20_week", 0, 5, {4, 5})});
  scan.before_points =
      "<name type=\"String\">K\xC3\xBC"
      "che</name>"
      "<acquisitionStart type=\"Structure\"><dateTimeValue "
      "type=\"Float\">1.2e9</dateTimeValue></acquisitionStart>";
  const std::string bytes = file_of({scan});
  const auto file = open_e57(bytes, "test.e57");
  EXPECT_EQ(file->clouds()[0].fields,
            (std::vector<std::string>{"x", "y", "z", "gps_time", "row_index", "column_index", "nx",
                                      "las:pointSourceId", "GPS week"}));
  const auto table = file->read(0)->next(10);
  ASSERT_TRUE(table);
  EXPECT_NE(table->find({"gps week"}), nullptr);
  EXPECT_NE(table->find({"las:pointsourceid"}), nullptr);
  EXPECT_EQ(e57_column(bytes, "gps_time"), (std::vector<double>{1.2e9 + 0.5, 1.2e9 + 1.5}));
  EXPECT_EQ(e57_column(bytes, "row_index"), (std::vector<double>{3, 9}));
  EXPECT_EQ(e57_column(bytes, "las:pointSourceId"), (std::vector<double>{77, 78}));
}

TEST(ReadE57, PosesOfSeveralScans) {
  ScanParts first = simple_scan(10);
  ScanParts second = simple_scan(20);
  second.before_points =
      "<name type=\"String\"><![CDATA[hall]]></name><pose type=\"Structure\"><rotation type=\"Structure\">"
      "<w type=\"Float\">2</w><x type=\"Float\"/><y type=\"Float\"/><z type=\"Float\">2</z></rotation>"
      "<translation type=\"Structure\"><x type=\"Float\">10</x><y "
      "type=\"Float\">-1.5e1</y></translation></pose>";
  const std::string bytes = file_of({first, second});
  const auto file = open_e57(bytes, "test.e57");
  ASSERT_EQ(file->clouds().size(), 2U);
  EXPECT_FALSE(file->clouds()[0].table.pose.has_value());
  const CloudFacts& facts = file->clouds()[1];
  ASSERT_TRUE(facts.table.pose.has_value());
  EXPECT_LT((*facts.table.pose * Vector3d(1, 2, 3) - Vector3d(8, -14, 3)).norm(), 1e-14);
  EXPECT_EQ(facts.table.possible_centre, Vector3d(10, -15, 0));
  EXPECT_EQ(facts.table.name, "test.e57, scan 2 (hall)");
  EXPECT_EQ(facts.points, 20U);
  ASSERT_FALSE(facts.notes.empty());
  EXPECT_NE(facts.notes[0].find("2.82842"), std::string::npos) << facts.notes[0];
  // Two streams at once.
  const auto a = file->read(0);
  const auto b = file->read(1);
  EXPECT_EQ(a->next(4)->rows, 4U);
  EXPECT_EQ(b->next(15)->rows, 15U);
  EXPECT_EQ(a->next(100)->rows, 6U);
  EXPECT_EQ(b->next(100)->rows, 5U);
  EXPECT_FALSE(a->next(1).has_value());
  EXPECT_FALSE(b->next(1).has_value());
}

TEST(ReadE57, ScansWithoutPointsAreStated) {
  ScanParts none = simple_scan(0);
  const std::string bytes = file_of({none});
  const auto file = open_e57(bytes, "test.e57");
  EXPECT_EQ(file->clouds()[0].points, 0U);
  EXPECT_EQ(file->clouds()[0].notes.at(0), "the scan holds no points");
  EXPECT_FALSE(file->read(0)->next(10).has_value());
  EXPECT_NE(message_of(file_of({})).find("no scans"), std::string::npos);
}

TEST(ReadE57, DamagedPagesAreNamed) {
  const std::string sound = file_of({simple_scan(3000)});
  EXPECT_EQ(message_of(sound), "");
  for (std::size_t page = 0; page < sound.size() / 1024; page += 3) {
    std::string bytes = sound;
    bytes[page * 1024 + 700] ^= 0x04;
    EXPECT_NE(message_of(bytes).find(fmt::format("checksum of page {} of", page)), std::string::npos) << page;
    EXPECT_NE(message_of(bytes).find(fmt::format("byte {}", page * 1024)), std::string::npos) << page;
  }
}

TEST(ReadE57, TruncatedFilesAreRefused) {
  const std::string sound = file_of({simple_scan(300)});
  for (std::size_t size = 0; size < sound.size(); size += 37) {
    EXPECT_NE(message_of(sound.substr(0, size)), "") << size;
  }
}

/// The file with one stretch of its payload replaced and all check sums right.
std::string with_payload(const std::vector<ScanParts>& scans, const std::string& from,
                         const std::string& to) {
  std::string logical = logical_file(scans, {});
  const std::size_t at = logical.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  EXPECT_EQ(from.size(), to.size());
  logical.replace(at, from.size(), to);
  return paged(logical, 1024);
}

TEST(ReadE57, PromisesThatDoNotFit) {
  const std::vector<ScanParts> scans{simple_scan(300)};
  EXPECT_NE(message_of(with_payload(scans, "recordCount=\"300\"", "recordCount=\"999\"")).find("promises"),
            std::string::npos);
  EXPECT_NE(message_of(with_payload(scans, "recordCount=\"300\"", "recordCount=\"9e9\""))
                .find("not a 64-bit integer"),
            std::string::npos);
  ScanParts many = simple_scan(300);
  many.points = 9223372036854775807U;
  EXPECT_NE(message_of(file_of({many})).find("promises"), std::string::npos);
  ScanParts constant;
  constant.points = 9223372036854775807U;
  for (const char* name : {"cartesianX", "cartesianY", "cartesianZ"})
    constant.columns.push_back(integer_column(name, 1, 0, {}));
  EXPECT_NE(message_of(file_of({constant})).find("promises"), std::string::npos);
  constant.points = 1000;
  EXPECT_EQ(message_of(file_of({constant})), "");
  EXPECT_EQ(e57_column(file_of({constant}), "x"), std::vector<double>(1000, 1.0));
}

TEST(ReadE57, PointsThatEndEarly) {
  ScanParts scan = simple_scan(300);
  scan.columns[1].stream.resize(8 * 200 + 3);
  scan.columns[0].stream.resize(8 * 400);
  scan.columns[2].stream.resize(8 * 400);
  EXPECT_NE(message_of(file_of({scan})).find("the points end after 200 of 300"), std::string::npos);
}

TEST(ReadE57, DamagedPackets) {
  const std::vector<ScanParts> scans{simple_scan(300)};
  const std::string logical = logical_file(scans, {});
  const std::size_t packet = 48 + 32;
  const auto with = [&](std::size_t at, char value) {
    std::string changed = logical;
    changed[at] = value;
    return message_of(paged(changed, 1024));
  };
  EXPECT_NE(with(packet, 7).find("unknown kind 7"), std::string::npos);
  EXPECT_NE(with(packet + 3, '\x7f').find("which is impossible"), std::string::npos);
  EXPECT_NE(with(packet + 2, 2).find("which is impossible"), std::string::npos);
  EXPECT_NE(with(packet + 4, 4).find("has 4 streams"), std::string::npos);
  EXPECT_NE(with(packet + 7, '\x7f').find("too short for its streams"), std::string::npos);
  EXPECT_NE(with(48, 3).find("no section"), std::string::npos);
  EXPECT_NE(with(48 + 15, 1).find("do not fit"), std::string::npos);
  EXPECT_NE(with(48 + 23, 1).find("behind the end"), std::string::npos);
  EXPECT_NE(with(48 + 16, 50).find("before its section"), std::string::npos);
}

TEST(ReadE57, HostileDescriptions) {
  const std::vector<ScanParts> scans{simple_scan(3, {integer_column("limen:n", 0, 2, {0, 1, 2})})};
  const auto message = [&](const std::string& from, const std::string& to) {
    return message_of(with_payload(scans, from, to));
  };
  EXPECT_NE(message("<data3D ", "<data3D<"), "");
  EXPECT_NE(message("</e57Root>", "          "), "");
  EXPECT_NE(message("minimum=\"0\" maximum=\"3\"", "minimum=\"4\" maximum=\"3\"").find("above"),
            std::string::npos);
  EXPECT_NE(message("minimum=\"0\"", "minimum=\"x\"").find("not a 64-bit integer"), std::string::npos);
  EXPECT_NE(message("type=\"Integer\"", "type=\"Numbers\"").find("not known"), std::string::npos);
  EXPECT_NE(message("CompressedVector", "CompressedSector").find("not a CompressedVector"),
            std::string::npos);
  EXPECT_NE(message("<points", "<pointz"), "");
  EXPECT_NE(message("type=\"Float\"/>\n<limen", "type=\"Float\">\n <limen"), "");
  // Nested a hundred thousand deep, inside and outside the prototype.
  std::string deep;
  for (int i = 0; i < 100000; ++i) deep += "<a type=\"Structure\">";
  std::string closed = deep;
  for (int i = 0; i < 100000; ++i) closed += "</a>";
  ScanParts nested = simple_scan(3);
  nested.before_points = closed;
  EXPECT_EQ(message_of(file_of({nested})), "");
  nested.before_points = deep;
  EXPECT_NE(message_of(file_of({nested})), "");
  nested.before_points.clear();
  nested.columns[0].element = closed.substr(1, closed.size() - 2) + "><b type=\"Float\"";
  EXPECT_NE(message_of(file_of({nested})).find("too deep"), std::string::npos);
}

TEST(ReadE57, QuaternionsThatAreNoRotation) {
  for (const char* w : {"0", "nan", "1e-300", "x"}) {
    ScanParts scan = simple_scan(3);
    scan.before_points = fmt::format("<pose><rotation><w type=\"Float\">{}</w></rotation></pose>", w);
    EXPECT_NE(message_of(file_of({scan})), "") << w;
  }
}

TEST(ReadE57, BytesChangedAtRandomNeverBreakIt) {
  ScanParts scan = simple_scan(40, {integer_column("limen:n", -3, 5, std::vector<std::int64_t>(40, 7))});
  scan.before_points = "<pose><rotation><w type=\"Float\">1</w></rotation></pose>";
  Layout layout;
  layout.packet_seed = 3;
  layout.packet_bytes = 60;
  const std::string sound = logical_file({scan, scan}, layout);
  RandomStream random(11);
  for (int trial = 0; trial < 3000; ++trial) {
    std::string logical = sound;
    const std::uint32_t changes = 1 + random.below(3);
    for (std::uint32_t k = 0; k < changes; ++k) {
      logical[random.below(static_cast<std::uint32_t>(logical.size()))] =
          static_cast<char>(random.below(256));
    }
    try {
      const std::string bytes = paged(logical, 1024);
      const auto file = open_e57(bytes, "test.e57");
      for (std::size_t k = 0; k < file->clouds().size(); ++k) {
        if (file->clouds()[k].points < 100000) (void)read_all(*file, k);
      }
    } catch (const Error&) {
      continue;  // named: that is what is asked
    }
  }
}

}  // namespace
}  // namespace limen
