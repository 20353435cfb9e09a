// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/las/laz/laz_writer.h"

#include <memory>
#include <string>

#include "support/laws.h"
#include "support/synthetic_laz.h"
#include <gtest/gtest.h>

#include "limen/base/parallel.h"
#include "limen/io/las/las.h"
#include "limen/io/las/laz/laz_info.h"
#include "limen/io/las/laz/laz_pack.h"

namespace limen {
namespace {

using testing_las::Parts;
using testing_las::records_of;

Parts parts_to_write(int format, std::size_t count, std::size_t extra = 0) {
  Parts parts;
  parts.format = format;
  parts.extra = extra;
  parts.points = testing_las::random_points(format, extra, count, 23);
  return parts;
}

/// The file, moved by nothing, as LAZ.
std::string as_laz(const std::string& las) {
  const testing_io::TemporaryFolder folder;
  transform_las(las, "test", Rigid3{}, folder / "out.laz");
  return testing_io::slurp(folder / "out.laz");
}

TEST(LazWriter, ChunksAreWhatAnotherEncoderMakes) {
  for (int format = 0; format <= 10; ++format) {
    for (const std::size_t extra : {std::size_t{0}, std::size_t{5}}) {
      const Parts parts = parts_to_write(format, 3000, extra);
      const auto items = laz::items_of(format, testing_las::point_bytes(parts));
      const std::string wanted = las_is_long_format(format) ? testing_laz::pack_layers(parts, parts.points, 3)
                                                            : testing_laz::pack_points(parts, parts.points);
      EXPECT_TRUE(laz::pack_chunk(items, parts.points) == wanted) << format << " " << extra;
    }
  }
}

TEST(LazWriter, EveryFormatComesBack) {
  for (int format = 0; format <= 10; ++format) {
    for (const std::size_t extra : {std::size_t{0}, std::size_t{3}}) {
      const Parts parts = parts_to_write(format, 1500, extra);
      const std::string laz = as_laz(testing_las::file(parts));
      const LasHeader header = parse_las_header(laz, "test");
      EXPECT_TRUE(header.compressed);
      EXPECT_EQ(header.point_format, format);
      EXPECT_EQ(header.points, 1500U);
      EXPECT_TRUE(header.notes.empty());
      EXPECT_TRUE(records_of(laz) == parts.points) << format << " " << extra;
    }
  }
}

TEST(LazWriter, SmallNumbersOfPoints) {
  for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{2}}) {
    for (const int format : {1, 7}) {
      const Parts parts = parts_to_write(format, count, 2);
      const std::string laz = as_laz(testing_las::file(parts));
      EXPECT_EQ(parse_las_header(laz, "test").points, count);
      EXPECT_TRUE(records_of(laz) == parts.points) << format;
    }
  }
}

TEST(LazWriter, ManyChunksAndTheSameBytesForAnyThreads) {
  const Parts parts = parts_to_write(7, 3 * kLazChunkPoints + 17);
  const std::string las = testing_las::file(parts);
  set_thread_count(1);
  const std::string one = as_laz(las);
  set_thread_count(0);
  EXPECT_TRUE(as_laz(las) == one);
  EXPECT_TRUE(records_of(one, 70000) == parts.points);
  EXPECT_LT(one.size(), las.size());
  const LazInfo info = parse_laz_info(one, "test", parse_las_header(one, "test"));
  ASSERT_EQ(info.chunks.size(), 4U);
  EXPECT_EQ(info.chunks[0].points, kLazChunkPoints);
  EXPECT_EQ(info.chunks[3].points, 17U);
}

TEST(LazWriter, AnyPiecesGiveTheSameBytes) {
  const Parts parts = parts_to_write(3, kLazChunkPoints + 1000);
  const testing_io::TemporaryFolder folder;
  const auto written = [&](std::size_t piece) {
    AtomicFile file(folder / "out");
    LazWriter writer(file, 0, laz::items_of(3, testing_las::point_bytes(parts)));
    for (std::size_t at = 0; at < parts.points.size(); at += piece)
      writer.write(std::string_view(parts.points).substr(at, piece));
    const std::uint64_t end = writer.finish();
    file.commit();
    EXPECT_EQ(std::filesystem::file_size(folder / "out"), end);
    return testing_io::slurp(folder / "out");
  };
  EXPECT_TRUE(written(34 * 999) == written(parts.points.size()));
}

TEST(LazWriter, RecordsAroundThePointsAreKept) {
  Parts parts = parts_to_write(6, 800, 1);
  parts.records.push_back(testing_las::record("LASF_Projection", 2112, "WKT"));
  parts.tail = testing_las::long_record("someone", 78, "behind");
  parts.tail_records = 1;
  const std::string once = as_laz(testing_las::file(parts));
  const std::string twice = as_laz(once);  // LAZ to LAZ
  EXPECT_TRUE(once == twice);
  const LasHeader header = parse_las_header(twice, "test");
  EXPECT_EQ(header.records.size(), 3U);
  ASSERT_NE(header.find("LASF_Projection", 2112), nullptr);
  ASSERT_NE(header.find("someone", 78), nullptr);
  EXPECT_EQ(header.find("someone", 78)->body, "behind");
  EXPECT_TRUE(records_of(twice) == parts.points);
}

TEST(LazWriter, NewFilesHoldWhatLasFilesHold) {
  CloudPlan plan;
  for (const char* name : {"x", "y", "z", "x_origin", "y_origin", "z_origin", "gps_time"})
    plan.columns.push_back({name, Scalar::float64});
  for (const char* name : {"red", "green", "blue"}) plan.columns.push_back({name, Scalar::uint8});
  plan.near = {652345.0, 6861234.0, 50.0};
  RandomStream random(4);
  auto numbers = std::make_shared<std::vector<double>>();
  for (int i = 0; i < 5000; ++i) {
    for (int round = 0; round < 2; ++round)
      for (const double middle : {652345.0, 6861234.0, 50.0})
        numbers->push_back(middle + random.uniform(-5.0, 5.0));
    numbers->push_back(3e8 + 1e-5 * i);
    for (int k = 0; k < 3; ++k) numbers->push_back(random.below(256));
  }
  std::vector<std::string> names;
  for (const ColumnPlan& column : plan.columns) names.push_back(column.name);
  const testing_io::TemporaryFolder folder;
  for (const char* name : {"out.las", "out.laz"}) {
    const auto writer = make_las_writer(folder / name, plan);
    writer->write(table_of_numbers(numbers, names));
    writer->finish();
  }
  const std::string las = testing_io::slurp(folder / "out.las");
  const std::string laz = testing_io::slurp(folder / "out.laz");
  EXPECT_TRUE(records_of(laz) == records_of(las));
  EXPECT_EQ(testing_las::column(laz, "x_origin").at(7), numbers->at(7 * 10 + 3));
  EXPECT_TRUE(parse_las_header(laz, "test").compressed);
  EXPECT_EQ(parse_las_header(laz, "test").high, parse_las_header(las, "test").high);
}

/// Points without any order: every bit of every field at any time.
std::string any_points(std::size_t bytes, int count) {
  std::string points;
  for (int i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < bytes; ++k) {
      const bool stays = i > 0 && *rc::gen::inRange(0, 3) > 0;
      points +=
          stays ? points[points.size() - bytes] : static_cast<char>(*rc::gen::arbitrary<std::uint8_t>());
    }
  }
  return points;
}

RC_GTEST_PROP(LazLaws, AnyPointsComeBack, ()) {
  const int format = *rc::gen::inRange(0, 11);
  Parts parts;
  parts.format = format;
  parts.extra = *rc::gen::inRange<std::size_t>(0, 4);
  parts.points = any_points(testing_las::point_bytes(parts), *rc::gen::inRange(1, 60));
  RC_ASSERT(records_of(as_laz(testing_las::file(parts))) == parts.points);
}

}  // namespace
}  // namespace limen
