// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <tuple>

#include "support/synthetic_las.h"
#include <gtest/gtest.h>

#include "limen/base/error.h"
#include "limen/io/las/las.h"

namespace limen {
namespace {

using testing_io::slurp;
using testing_io::TemporaryFolder;
using testing_las::column;
using testing_las::file;
using testing_las::Parts;

Rigid3 turned() {
  Rigid3 motion;
  motion.rotation = rotation_exp({0.02, -0.01, 0.7});
  motion.translation = {-480000.0, 1000.0, 12.5};
  return motion;
}

Parts sample(int minor, int format) {
  Parts parts;
  parts.minor = minor;
  parts.format = format;
  parts.extra = 3;
  parts.points = testing_las::random_points(format, 3, 300, 5);
  parts.records.push_back(testing_las::record("LASF_Projection", 2112, "WKT"));
  parts.records.push_back(testing_las::record("someone", 77, "odd\0bytes"));
  if (minor == 4) {
    parts.tail = testing_las::long_record("someone", 78, "behind the points");
    parts.tail_records = 1;
  }
  return parts;
}

TransformedCloud move(const std::string& bytes, const Rigid3& motion, std::string& moved) {
  const TemporaryFolder folder;
  const TransformedCloud result = transform_las(bytes, "test", motion, folder / "out.las");
  moved = slurp(folder / "out.las");
  return result;
}

std::vector<Vector3d> points_of(const std::string& bytes) {
  const auto x = column(bytes, "x");
  const auto y = column(bytes, "y");
  const auto z = column(bytes, "z");
  std::vector<Vector3d> points;
  for (std::size_t i = 0; i < x.size(); ++i) points.emplace_back(x[i], y[i], z[i]);
  return points;
}

TEST(TransformLas, ACoordinateSystemTakesThePlaceOfTheSources) {
  const TemporaryFolder folder;
  const LasSystem system{"PROJCS[\"new\",UNIT[\"metre\",1]]", "EPSG:2154"};
  for (const auto& [minor, format, ending] :
       {std::tuple{2, 3, ".las"}, {4, 7, ".las"}, {2, 3, ".laz"}, {4, 7, ".laz"}}) {
    const std::string before = file(sample(minor, format));
    const std::string name = std::string("out") + ending;
    const TransformedCloud result =
        transform_las(before, "test", turned(), folder / name, silent_monitor(), system);
    const std::string after = slurp(folder / name);
    const LasHeader header = parse_las_header(after, "test");
    EXPECT_EQ(result.points, 300U);
    EXPECT_TRUE(result.notes.empty());
    EXPECT_EQ(las_coordinate_systems(header),
              std::vector<std::string>{minor == 4 ? system.wkt : system.code});
    EXPECT_EQ((header.global_encoding & 16U) != 0, minor == 4);
    EXPECT_NE(header.find("someone", 77), nullptr);
    EXPECT_EQ(las_number<std::uint32_t>(after, las_at::kRecordCount),
              static_cast<std::uint32_t>(std::count_if(header.records.begin(), header.records.end(),
                                                       [](const LasRecord& it) { return !it.extended; })));
    const auto old_points = points_of(before);
    const auto new_points = points_of(after);
    for (std::size_t i = 0; i < old_points.size(); ++i)
      EXPECT_LT((turned() * old_points[i] - new_points[i]).cwiseAbs().maxCoeff(), 5.1e-5);
  }
  // Without a number old versions have no place for it, and that is noted.
  const TransformedCloud stated = transform_las(file(sample(2, 3)), "test", turned(), folder / "old.las",
                                                silent_monitor(), {system.wkt, ""});
  ASSERT_EQ(stated.notes.size(), 1U);
  EXPECT_TRUE(las_coordinate_systems(parse_las_header(slurp(folder / "old.las"), "test")).empty());
}

TEST(TransformLas, MovesPointsAndKeepsAllElse) {
  for (const auto& [minor, format] : {std::pair{2, 3}, {4, 7}, {3, 5}, {4, 10}}) {
    const std::string before = file(sample(minor, format));
    std::string after;
    const TransformedCloud result = move(before, turned(), after);
    EXPECT_EQ(result.points, 300U);
    ASSERT_EQ(after.size(), before.size());
    const LasHeader old_header = parse_las_header(before, "test");
    const LasHeader new_header = parse_las_header(after, "test");
    EXPECT_DOUBLE_EQ(new_header.scale.x(), 1e-4);
    const auto old_points = points_of(before);
    const auto new_points = points_of(after);
    Vector3d low = new_points[0];
    for (std::size_t i = 0; i < old_points.size(); ++i) {
      EXPECT_LT((turned() * old_points[i] - new_points[i]).cwiseAbs().maxCoeff(), 5.1e-5);
      low = low.cwiseMin(new_points[i]);
    }
    EXPECT_LT((new_header.low - low).norm(), 1e-6);
    // Only coordinates, steps, offsets and the box may differ.
    std::string same = after;
    std::copy_n(before.begin() + las_at::kScale, 96, same.begin() + las_at::kScale);
    for (std::size_t i = 0; i < 300; ++i) {
      const std::size_t at = old_header.points_begin + i * old_header.point_bytes;
      std::copy_n(before.begin() + static_cast<std::ptrdiff_t>(at), 12,
                  same.begin() + static_cast<std::ptrdiff_t>(at));
    }
    EXPECT_EQ(same, before);
  }
}

TEST(TransformLas, AShiftKeepsTheIntegers) {
  Rigid3 shift;
  shift.translation = {0.25, -3.0, 100.0};
  const std::string before = file(sample(4, 6));
  std::string after;
  const TransformedCloud result = move(before, shift, after);
  EXPECT_EQ(testing_las::records_of(before), testing_las::records_of(after));
  EXPECT_EQ(parse_las_header(after, "test").scale, parse_las_header(before, "test").scale);
  EXPECT_DOUBLE_EQ(column(after, "z").at(5), column(before, "z").at(5) + 100.0);
  EXPECT_NE(result.notes.at(0).find("coordinate system"), std::string::npos);
}

TEST(TransformLas, ASmallCorrectionNeedsNoWarning) {
  Rigid3 shift;
  shift.translation = {0.25, -3.0, 1.0};
  std::string after;
  EXPECT_TRUE(move(file(sample(4, 6)), shift, after).notes.empty());
}

TEST(TransformLas, AWrongBoxDoesNoHarm) {
  std::string before = file(sample(2, 1));
  for (const auto& [low, high] : {std::pair{-1e12, 1e12}, {0.0, 1e-9}, {1.0, -1.0}, {-1e300, 1e300}}) {
    for (std::size_t k = 0; k < 3; ++k) {
      testing_las::put(before, las_at::kBounds + 16 * k, high);
      testing_las::put(before, las_at::kBounds + 16 * k + 8, low);
    }
    std::string after;
    move(before, turned(), after);
    EXPECT_DOUBLE_EQ(parse_las_header(after, "test").scale.x(), 1e-4);
    EXPECT_LT((turned() * points_of(before)[9] - points_of(after)[9]).cwiseAbs().maxCoeff(), 5.1e-5);
  }
}

TEST(TransformLas, TheScannerMovesToo) {
  Parts parts = sample(4, 6);
  const Vector3d centre{500001.0, 5400002.0, 103.0};
  std::string body(24, '\0');
  for (int k = 0; k < 3; ++k) testing_las::put(body, 8 * static_cast<std::size_t>(k), centre[k]);
  parts.records.push_back(testing_las::record(kLasCentreUser, kLasCentreNumber, body));
  std::string after;
  move(file(parts), turned(), after);
  const auto opened = open_las(after, "test");
  EXPECT_LT((opened->clouds()[0].table.centre.value() - turned() * centre).norm(), 1e-9);
}

TEST(TransformLas, PlacesAndDirectionsInExtraBytesMoveToo) {
  const TemporaryFolder folder;
  CloudPlan plan;
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz", "x_origin", "y_origin", "z_origin"})
    plan.columns.push_back({name, name[0] == 'n' ? Scalar::float32 : Scalar::float64});
  plan.near = {500000.0, 5400000.0, 100.0};
  const Vector3d normal = Vector3d(1, 2, 2) / 3.0;
  const Vector3d centre(500001.25, 5400002.5, 103.0);
  const std::vector<double> numbers = {500000.0,   5400000.0,  100.0,      normal.x(), normal.y(),
                                       normal.z(), centre.x(), centre.y(), centre.z()};
  std::vector<std::string> names;
  for (const ColumnPlan& one : plan.columns) names.push_back(one.name);
  const auto writer = make_las_writer(folder / "in.las", plan);
  writer->write(table_of_numbers(std::make_shared<const std::vector<double>>(numbers), names));
  writer->finish();
  Rigid3 shift;
  shift.translation = {0.25, -3.0, 100.0};
  for (const Rigid3& motion : {turned(), shift}) {
    std::string after;
    move(slurp(folder / "in.las"), motion, after);
    const auto three = [&](const char* a, const char* b, const char* c) {
      return Vector3d(column(after, a).at(0), column(after, b).at(0), column(after, c).at(0));
    };
    EXPECT_LT((three("nx", "ny", "nz") - motion.rotation * normal).norm(), 1e-6);
    EXPECT_LT((three("x_origin", "y_origin", "z_origin") - motion * centre).norm(), 1e-8);
  }
}

TEST(TransformLas, NothingIsLeftWhereItFails) {
  const TemporaryFolder folder;
  std::string bytes = file(sample(2, 1));
  bytes.pop_back();
  EXPECT_THROW(transform_las(bytes, "test", turned(), folder / "out.las"), Error);
  Rigid3 far = turned();
  far.translation.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(transform_las(file(sample(2, 1)), "test", far, folder / "out.las"), Error);
  EXPECT_EQ(folder.files(), 0U);
}

}  // namespace
}  // namespace limen
