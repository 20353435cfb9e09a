// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>
#include <memory>

#include "support/synthetic_las.h"
#include <gtest/gtest.h>

#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/base/text.h"
#include "limen/io/las/las.h"

namespace limen {
namespace {

using testing_io::slurp;
using testing_io::TemporaryFolder;
using testing_las::column;

/// A cloud of doubles: the plan tells what they are.
RecordTable table_of(const CloudPlan& plan, std::vector<double> numbers) {
  std::vector<std::string> names;
  for (const ColumnPlan& one : plan.columns) names.push_back(lower_case(one.name));
  return table_of_numbers(std::make_shared<const std::vector<double>>(std::move(numbers)), names);
}

CloudPlan plan_with(std::vector<ColumnPlan> more) {
  CloudPlan plan;
  for (const char* name : {"x", "y", "z"}) plan.columns.push_back({name, Scalar::float64});
  plan.columns.insert(plan.columns.end(), more.begin(), more.end());
  plan.near = {652345.0, 6861234.0, 50.0};
  return plan;
}

std::string written(const CloudPlan& plan, const std::vector<std::vector<double>>& pieces) {
  const TemporaryFolder folder;
  const auto writer = make_las_writer(folder / "out.las", plan);
  for (const std::vector<double>& piece : pieces) writer->write(table_of(plan, piece));
  EXPECT_FALSE(std::filesystem::exists(folder / "out.las"));
  writer->finish();
  return slurp(folder / "out.las");
}

TEST(WriteLas, KnownColumnsGoToTheirPlaces) {
  const CloudPlan plan = plan_with({{"Intensity", Scalar::uint16},
                                    {"GPS_time", Scalar::float64},
                                    {"return_number", Scalar::uint8},
                                    {"number_of_returns", Scalar::uint8},
                                    {"classification", Scalar::uint8},
                                    {"withheld", Scalar::uint8},
                                    {"scanner_channel", Scalar::uint8},
                                    {"scan_angle", Scalar::float64},
                                    {"point_source_id", Scalar::uint16},
                                    {"red", Scalar::uint8},
                                    {"green", Scalar::uint8},
                                    {"blue", Scalar::uint8}});
  const std::string bytes =
      written(plan, {{652000.12345, 6861000.5, 49.99999, 4660, 3e8, 2, 3, 64, 1, 2, -30, 9, 255, 128, 0},
                     {652001.0, 6861001.0, 40.0, 1, 3.1e8, 3, 3, 6, 0, 0, 0, 9, 1, 2, 3}});
  const LasHeader header = parse_las_header(bytes, "test");
  EXPECT_EQ(header.minor, 4);
  EXPECT_EQ(header.point_format, 7);
  EXPECT_EQ(header.point_bytes, 36U);
  EXPECT_EQ(header.points, 2U);
  EXPECT_EQ(header.global_encoding, 17);  // WKT, and times that no week has
  EXPECT_NEAR(header.low.z(), 40.0, 1e-9);
  EXPECT_NEAR(header.high.x(), 652001.0, 1e-9);
  EXPECT_EQ(las_number<std::uint64_t>(bytes, las_at::kReturns + 8), 1U);
  EXPECT_EQ(las_number<std::uint64_t>(bytes, las_at::kReturns + 16), 1U);
  EXPECT_NEAR(column(bytes, "x").at(0), 652000.12345, 5.1e-5);
  EXPECT_NEAR(column(bytes, "z").at(0), 49.99999, 5.1e-5);
  const std::vector<std::pair<const char*, double>> first{
      {"intensity", 4660},       {"gps_time", 3e8}, {"return_number", 2},   {"number_of_returns", 3},
      {"classification", 64},    {"withheld", 1},   {"scanner_channel", 2}, {"scan_angle", -30},
      {"point_source_id", 9},    {"red", 65535},    {"green", 128 * 257},   {"blue", 0},
      {"edge_of_flight_line", 0}};
  for (const auto& [name, value] : first) EXPECT_DOUBLE_EQ(column(bytes, name).at(0), value) << name;
}

TEST(WriteLas, OtherColumnsBecomeExtraBytesOfTheirType) {
  const CloudPlan plan = plan_with({{"Range", Scalar::float32},
                                    {"scan_line", Scalar::int32},
                                    {"intensity", Scalar::float32},
                                    {"beam", Scalar::int8},
                                    {"stamp", Scalar::uint64}});
  const std::string bytes = written(plan, {{652000, 6861000, 50, 12.5, -70000, 0.25, -5, 4294967296.0}});
  EXPECT_EQ(column(bytes, "range").at(0), 12.5);
  EXPECT_EQ(column(bytes, "scan_line").at(0), -70000.0);
  EXPECT_EQ(column(bytes, "intensity").at(0), 0.25);  // exact, from the extra bytes
  EXPECT_EQ(column(bytes, "las_intensity").at(0), std::floor(0.25 * 65535 + 0.5));
  EXPECT_EQ(column(bytes, "beam").at(0), -5.0);
  EXPECT_EQ(column(bytes, "stamp").at(0), 4294967296.0);
  EXPECT_EQ(column(bytes, "return_number").at(0), 1.0);
}

TEST(WriteLas, TimesGoToTheirPlaceByAnyName) {
  for (const char* name : {"GPS_time", "gpstime", "time", "t", "timestamp"}) {
    const std::string bytes = written(plan_with({{name, Scalar::float64}}), {{652000, 6861000, 3, 12.5}});
    EXPECT_EQ(column(bytes, "gps_time"), std::vector<double>{12.5}) << name;
    EXPECT_EQ(parse_las_header(bytes, "test").point_bytes, 30U) << name;
  }
}

TEST(WriteLas, ATimeThatNobodyKnowsIsZero) {
  const std::string bytes =
      written(plan_with({{"gps_time", Scalar::float64}}), {{652000, 6861000, 3, std::nan("")}});
  EXPECT_EQ(column(bytes, "gps_time"), std::vector<double>{0.0});
}

TEST(WriteLas, AStandardValueIsMadeAnewFromTheMoreExactOne) {
  const CloudPlan plan = plan_with({{"intensity", Scalar::float32}, {"las_intensity", Scalar::uint16}});
  const std::string bytes = written(plan, {{652000, 6861000, 3, 0.25, 7}});
  EXPECT_EQ(column(bytes, "intensity").at(0), 0.25);
  EXPECT_EQ(column(bytes, "las_intensity").at(0), 16384);
  EXPECT_TRUE(column(bytes, "las_las_intensity").empty());
}

TEST(WriteLas, NearInfraredMakesFormat8) {
  const CloudPlan plan = plan_with({{"red", Scalar::uint16},
                                    {"green", Scalar::uint16},
                                    {"blue", Scalar::uint16},
                                    {"nir", Scalar::uint16}});
  const std::string bytes = written(plan, {{652000, 6861000, 50, 1, 300, 65535, 9}});
  EXPECT_EQ(parse_las_header(bytes, "test").point_format, 8);
  EXPECT_EQ(column(bytes, "red").at(0), 1.0);
  EXPECT_EQ(column(bytes, "nir").at(0), 9.0);
}

TEST(WriteLas, CentreAndCoordinateSystemComeBack) {
  CloudPlan plan = plan_with({});
  plan.centre = Vector3d(652010.5, 6861010.25, 51.125);
  plan.georeference = {"PROJCRS[...]"};
  const std::string bytes = written(plan, {{652000, 6861000, 50}});
  EXPECT_EQ(las_coordinate_systems(parse_las_header(bytes, "test")), plan.georeference);
  const auto opened = open_las(bytes, "test");
  EXPECT_EQ(opened->clouds()[0].table.centre.value(), *plan.centre);
}

TEST(WriteLas, RowsWithoutCoordinatesAreLeftOut) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::string bytes =
      written(plan_with({}), {{652000, 6861000, 50, nan, nan, nan, 652001, 6861001, 51}});
  EXPECT_EQ(column(bytes, "z"), (std::vector<double>{50.0, 51.0}));
  EXPECT_EQ(las_number<std::uint64_t>(bytes, las_at::kReturns), 2U);
}

TEST(WriteLas, TheSameBytesForAnyThreads) {
  CloudPlan plan = plan_with({{"intensity", Scalar::uint16}, {"range", Scalar::float32}});
  RandomStream random(1);
  std::vector<double> numbers;
  for (int i = 0; i < 100000; ++i) {
    for (const double middle : {652345.0, 6861234.0, 50.0})
      numbers.push_back(middle + random.uniform(-50.0, 50.0));
    numbers.push_back(random.below(65536));
    numbers.push_back(random.below(100));
  }
  set_thread_count(1);
  const std::string one = written(plan, {numbers});
  set_thread_count(0);
  EXPECT_EQ(one, written(plan, {numbers}));
  const auto x = column(one, "x", 30000);
  ASSERT_EQ(x.size(), 100000U);
  for (std::size_t i = 0; i < x.size(); ++i) ASSERT_NEAR(x[i], numbers[5 * i], 5.1e-5);
}

TEST(WriteLas, RefusesWhatItCannotHold) {
  EXPECT_THROW(written(plan_with({}), {{652000, 6861000, 1e7}}), Error);
  CloudPlan flat;
  flat.columns = {{"x", Scalar::float64}, {"y", Scalar::float64}};
  const TemporaryFolder folder;
  EXPECT_THROW(make_las_writer(folder / "out.las", flat), Error);
  EXPECT_EQ(folder.files(), 0U);
  EXPECT_THROW(make_las_writer(folder / "no" / "out.las", plan_with({})), Error);
}

}  // namespace
}  // namespace limen
