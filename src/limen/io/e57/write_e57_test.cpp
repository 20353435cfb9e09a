// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>
#include <map>

#include "support/synthetic_e57.h"
#include "support/test_support.h"
#include <gtest/gtest.h>

#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/base/text.h"
#include "limen/io/e57/e57.h"
#include "limen/io/e57/e57_document.h"

namespace limen {
namespace {

using namespace testing_e57;
using testing_io::slurp;
using testing_io::TemporaryFolder;

/// Numbers of one column, as doubles, and how they lie in memory.
struct Given {
  Given(std::string name, Scalar type, std::vector<double> numbers) : values(std::move(numbers)) {
    plan.name = std::move(name);
    plan.type = type;
  }

  ColumnPlan plan;
  std::vector<double> values;
};

template <typename Value>
void pack(std::string& bytes, const std::vector<double>& values) {
  for (const double value : values) put(bytes, static_cast<Value>(value));
}

/// A table whose columns hold rows [begin, end), each as its plan says.
RecordTable table_of(const std::vector<Given>& columns, std::size_t begin, std::size_t end) {
  auto memory = std::make_shared<std::vector<std::string>>();
  RecordTable table;
  table.rows = end - begin;
  for (const Given& column : columns) {
    const std::vector<double> values(column.values.begin() + static_cast<std::ptrdiff_t>(begin),
                                     column.values.begin() + static_cast<std::ptrdiff_t>(end));
    std::string bytes;
    switch (column.plan.type) {
      case Scalar::int8:
        pack<std::int8_t>(bytes, values);
        break;
      case Scalar::uint8:
        pack<std::uint8_t>(bytes, values);
        break;
      case Scalar::int16:
        pack<std::int16_t>(bytes, values);
        break;
      case Scalar::uint16:
        pack<std::uint16_t>(bytes, values);
        break;
      case Scalar::int32:
        pack<std::int32_t>(bytes, values);
        break;
      case Scalar::uint32:
        pack<std::uint32_t>(bytes, values);
        break;
      case Scalar::int64:
        pack<std::int64_t>(bytes, values);
        break;
      case Scalar::uint64:
        pack<std::uint64_t>(bytes, values);
        break;
      case Scalar::float32:
        pack<float>(bytes, values);
        break;
      case Scalar::float64:
        pack<double>(bytes, values);
        break;
    }
    memory->push_back(std::move(bytes));
  }
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const Scalar type = columns[k].plan.type;
    table.fields.push_back({lower_case(columns[k].plan.name), type, (*memory)[k].data(), size_of(type)});
  }
  table.keeper = std::move(memory);
  return table;
}

std::vector<double> noise(std::size_t count, double low, double high, std::uint64_t seed,
                          bool whole = false) {
  RandomStream random(seed);
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) {
    const double value = random.uniform(low, high);
    values.push_back(whole ? std::floor(value) : value);
  }
  return values;
}

std::vector<Given> points(std::size_t count) {
  std::vector<Given> columns;
  columns.emplace_back("x", Scalar::float64, noise(count, 1e6, 1e6 + 100, 1));
  columns.emplace_back("y", Scalar::float64, noise(count, 6.8e6, 6.8e6 + 100, 2));
  columns.emplace_back("z", Scalar::float64, noise(count, -5, 5, 3));
  return columns;
}

CloudPlan plan_of(const std::vector<Given>& columns) {
  CloudPlan plan;
  plan.name = "a ]]> b <c> & \xC3\xA4";
  plan.near = {1e6, 6.8e6, 0.0};
  plan.most_points = columns[0].values.size();
  for (const Given& column : columns) plan.columns.push_back(column.plan);
  return plan;
}

std::string written(const TemporaryFolder& folder, const std::vector<Given>& columns, const CloudPlan& plan,
                    std::size_t piece = 100000) {
  const auto path = folder / "out.e57";
  const auto writer = make_e57_writer(path, plan);
  const std::size_t count = columns[0].values.size();
  for (std::size_t begin = 0; begin < count; begin += piece)
    writer->write(table_of(columns, begin, std::min(count, begin + piece)));
  writer->finish();
  return slurp(path);
}

/// The columns of the only cloud, coordinates in the frame of the file, by name.
std::map<std::string, std::vector<double>> read_back(const std::string& bytes) {
  const auto file = open_e57(bytes, "out.e57");
  auto columns = read_all(*file, 0, 777);
  const CloudFacts& facts = file->clouds().at(0);
  EXPECT_EQ(facts.table.pose->rotation, Matrix3d::Identity());
  std::map<std::string, std::vector<double>> named;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::string letter(1, "xyz"[axis]);
      if (facts.fields[k] != letter && facts.fields[k] != letter + "_origin") continue;
      for (double& value : columns[k]) value += facts.table.pose->translation[static_cast<int>(axis)];
    }
    named[facts.fields[k]] = std::move(columns[k]);
  }
  return named;
}

void expect_near(const std::vector<double>& a, const std::vector<double>& b, double tolerance) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) ASSERT_NEAR(a[i], b[i], tolerance) << i;
}

TEST(WriteE57, EveryTypeAndNameComesBack) {
  const std::size_t n = 5003;
  std::vector<Given> columns = points(n);
  columns.emplace_back("Intensity", Scalar::uint16, noise(n, 0, 65536, 4, true));
  columns.emplace_back("red", Scalar::uint8, noise(n, 0, 256, 5, true));
  columns.emplace_back("green", Scalar::uint8, noise(n, 0, 256, 6, true));
  columns.emplace_back("blue", Scalar::uint8, noise(n, 0, 256, 7, true));
  columns.emplace_back("GPS_time", Scalar::float64, noise(n, 3e8, 3e8 + 60, 8));
  columns.emplace_back("scan_line", Scalar::int32, noise(n, -9, 3000, 9, true));
  columns.emplace_back("scan_index", Scalar::int32, noise(n, 0, 3000, 10, true));
  columns.emplace_back("nx", Scalar::float32, noise(n, 0, 1, 11, true));
  columns.emplace_back("Odd name (%)", Scalar::int8, noise(n, -128, 128, 12, true));
  columns.emplace_back("_x20_", Scalar::int16, noise(n, -32768, 32768, 13, true));
  columns.emplace_back("9lives", Scalar::uint32, noise(n, 0, 4294967296.0, 14, true));
  columns.emplace_back("big", Scalar::int64, noise(n, -9e15, 9e15, 15, true));
  columns.emplace_back("great", Scalar::uint64, noise(n, 0, 9e15, 16, true));
  columns.emplace_back("reflectance", Scalar::float32, noise(n, 0, 50, 17, true));
  const TemporaryFolder folder;
  const auto back = read_back(written(folder, columns, plan_of(columns)));
  EXPECT_EQ(back.size(), columns.size());
  for (std::size_t k = 0; k < 3; ++k) expect_near(back.at(columns[k].plan.name), columns[k].values, 2e-9);
  EXPECT_EQ(back.at("intensity"), columns[3].values);
  EXPECT_EQ(back.at("red"), columns[4].values);
  EXPECT_EQ(back.at("green"), columns[5].values);
  EXPECT_EQ(back.at("blue"), columns[6].values);
  EXPECT_EQ(back.at("gps_time"), columns[7].values);
  EXPECT_EQ(back.at("column_index"), columns[8].values);
  EXPECT_EQ(back.at("row_index"), columns[9].values);
  EXPECT_EQ(back.at("nx"), columns[10].values);
  EXPECT_EQ(back.at("Odd name (%)"), columns[11].values);
  EXPECT_EQ(back.at("_x20_"), columns[12].values);
  EXPECT_EQ(back.at("9lives"), columns[13].values);
  EXPECT_EQ(back.at("big"), columns[14].values);
  EXPECT_EQ(back.at("great"), columns[15].values);
  EXPECT_EQ(back.at("reflectance"), columns[16].values);
}

TEST(WriteE57, IntegersOfAnEighthOfTheResolution) {
  const std::vector<Given> columns = points(3000);
  const TemporaryFolder folder;
  CloudPlan plan = plan_of(columns);
  const std::string doubles = written(folder, columns, plan);
  plan.resolution_m = 0.001;
  const std::string integers = written(folder, columns, plan);
  EXPECT_LT(integers.size(), doubles.size() * 6 / 10);
  const auto back = read_back(integers);
  for (std::size_t k = 0; k < 3; ++k)
    expect_near(back.at(columns[k].plan.name), columns[k].values, 0.001 / 16 + 2e-9);
}

TEST(WriteE57, PointsThatAreNoNumbersStayAtTheirRows) {
  std::vector<Given> columns = points(200);
  columns.emplace_back("intensity", Scalar::float32, noise(200, 0, 9, 4, true));
  columns[1].values[17] = std::numeric_limits<double>::quiet_NaN();
  columns[2].values[199] = std::numeric_limits<double>::infinity();
  for (const double resolution_m : {0.0, 0.001}) {
    const TemporaryFolder folder;
    CloudPlan plan = plan_of(columns);
    plan.resolution_m = resolution_m;
    const auto back = read_back(written(folder, columns, plan));
    for (std::size_t i = 0; i < 200; ++i) {
      EXPECT_EQ(std::isnan(back.at("x")[i]), i == 17 || i == 199);
      EXPECT_EQ(std::isnan(back.at("z")[i]), i == 17 || i == 199);
    }
    EXPECT_EQ(back.at("intensity"), columns[3].values);
  }
}

TEST(WriteE57, TheSameBytesForAnyPiecesAndThreads) {
  std::vector<Given> columns = points(20011);
  columns.emplace_back("class", Scalar::uint8, noise(20011, 0, 256, 4, true));
  const TemporaryFolder folder;
  const std::string whole = written(folder, columns, plan_of(columns));
  EXPECT_EQ(written(folder, columns, plan_of(columns), 1009), whole);
  set_thread_count(1);
  EXPECT_EQ(written(folder, columns, plan_of(columns), 64), whole);
  set_thread_count(0);
  columns[3].values[5] += columns[3].values[5] > 0 ? -1 : 1;
  EXPECT_NE(written(folder, columns, plan_of(columns)), whole);
}

TEST(WriteE57, CentresAndCoordinateSystems) {
  const std::size_t n = 100;
  std::vector<Given> columns = points(n);
  const TemporaryFolder folder;
  CloudPlan plan = plan_of(columns);
  plan.georeference = {"PROJCS[\"somewhere\"]"};
  const std::string unknown = written(folder, columns, plan);
  EXPECT_TRUE(open_e57(unknown, "out.e57")->clouds()[0].table.centre_unknown);
  plan.centre = Vector3d(1e6 + 3, 6.8e6 + 4, 1.5);
  const std::string known = written(folder, columns, plan);
  const auto file = open_e57(known, "out.e57");
  EXPECT_EQ(file->clouds()[0].table.centre, plan.centre);
  EXPECT_EQ(file->clouds()[0].table.pose->translation, *plan.centre);
  const E57Pages pages(known, "out.e57");
  const E57Document document = parse_e57_document(e57_xml(pages), "out.e57");
  EXPECT_EQ(e57_coordinate_systems(known, "out.e57"), plan.georeference);
  EXPECT_EQ(document.scans[0].name, plan.name);
  plan.centre.reset();
  for (const char* name : {"x_origin", "y_origin", "z_origin"})
    columns.emplace_back(name, Scalar::float32, noise(n, 1, 2, 21, true));
  columns[3].values.assign(n, 1000003.0);
  for (std::size_t k = 3; k < 6; ++k) plan.columns.push_back(columns[k].plan);
  const auto back = read_back(written(folder, columns, plan));
  for (std::size_t k = 3; k < 6; ++k) EXPECT_EQ(back.at(columns[k].plan.name), columns[k].values);
}

TEST(WriteE57, ColoursOfOtherKinds) {
  const std::size_t n = 50;
  std::vector<Given> columns = points(n);
  const TemporaryFolder folder;
  for (const char* name : {"red", "green", "blue"})
    columns.emplace_back(name, Scalar::uint16, noise(n, 0, 65536, 22, true));
  auto back = read_back(written(folder, columns, plan_of(columns)));
  EXPECT_EQ(back.at("green"), columns[4].values);
  for (std::size_t k = 3; k < 6; ++k)
    columns[k] = Given(columns[k].plan.name, Scalar::float32, noise(n, 0, 1, k));
  back = read_back(written(folder, columns, plan_of(columns)));
  for (std::size_t i = 0; i < n; ++i) EXPECT_NEAR(back.at("blue")[i], 255 * columns[5].values[i], 1e-4);
}

TEST(WriteE57, NothingIsLeftWhereARowDoesNotFit) {
  const TemporaryFolder folder;
  std::vector<Given> columns = points(100);
  columns[0].values[50] = 1e8;
  CloudPlan plan = plan_of(columns);
  plan.resolution_m = 0.001;
  EXPECT_THROW((void)written(folder, columns, plan), Error);
  columns = points(100);
  columns.emplace_back("n", Scalar::uint64, std::vector<double>(100, 1.0));
  columns[3].values[99] = 1e19;
  EXPECT_THROW((void)written(folder, columns, plan_of(columns)), Error);
  EXPECT_EQ(folder.files(), 0U);
  EXPECT_THROW((void)make_e57_writer(folder / "nowhere" / "out.e57", plan), Error);
  plan.columns.erase(plan.columns.begin());
  EXPECT_THROW((void)make_e57_writer(folder / "out.e57", plan), Error);
  std::vector<Given> wide = points(10);
  for (int k = 0; k < 200; ++k)
    wide.emplace_back(fmt::format("c{}", k), Scalar::float64, std::vector<double>(10, 1.0));
  EXPECT_THROW((void)make_e57_writer(folder / "out.e57", plan_of(wide)), Error);
  EXPECT_EQ(folder.files(), 0U);
}

TEST(WriteE57, NoPointsAtAll) {
  const std::vector<Given> columns = points(0);
  const TemporaryFolder folder;
  const std::string bytes = written(folder, columns, plan_of(columns));
  const auto file = open_e57(bytes, "out.e57");
  EXPECT_EQ(file->clouds()[0].points, 0U);
  EXPECT_FALSE(file->read(0)->next(10).has_value());
}

TEST(WriteE57, NamesAreEscapedAndBack) {
  for (const char* name :
       {"plain", "9", "-a", "a b", "_x20_", "_x_", "x_x2", "\xC3\xA4<>&\"", "_x5f_x20_", ""}) {
    const std::string escaped = e57_escaped_name(name);
    EXPECT_EQ(e57_plain_name(escaped), name);
    EXPECT_EQ(escaped.find_first_of(" <>&\"\xC3"), std::string::npos);
    EXPECT_FALSE(escaped.empty());
  }
}

}  // namespace
}  // namespace limen
