// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/las/laz/copc_writer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "support/synthetic_las.h"
#include <gtest/gtest.h>

#include "limen/base/parallel.h"
#include "limen/base/random.h"
#include "limen/io/las/las.h"
#include "limen/io/las/las_records.h"
#include "limen/io/las/laz/laz_info.h"

namespace limen {
namespace {

using Key = std::tuple<int, int, int, int>;  // level, x, y, z

/// A node as the hierarchy has it.
struct Entry {
  std::uint64_t place = 0;
  std::int32_t bytes = 0;
  std::int32_t points = 0;
};

/// What a reader of COPC goes by.
struct Copc {
  std::string bytes;
  LasHeader header;
  Vector3d centre;
  double half = 0.0;
  double spacing = 0.0;
  std::map<Key, Entry> nodes;

  explicit Copc(std::string file) : bytes(std::move(file)), header(parse_las_header(bytes, "test")) {
    centre = las_vector(bytes, 429);
    half = las_number<double>(bytes, 453);
    spacing = las_number<double>(bytes, 461);
    const auto page = las_number<std::uint64_t>(bytes, 469);
    const auto size = las_number<std::uint64_t>(bytes, 477);
    for (std::uint64_t at = page; at < page + size; at += 32) {
      const auto number = [&](std::size_t k) { return las_number<std::int32_t>(bytes, at + 4 * k); };
      nodes[{number(0), number(1), number(2), number(3)}] = {las_number<std::uint64_t>(bytes, at + 16),
                                                             number(6), number(7)};
    }
  }
};

/// Points of four walls and a floor far from zero, and so many times one point more.
std::vector<Vector3d> room_points(std::size_t count, std::size_t of_one) {
  RandomStream random(7);
  const Vector3d corner(652345.0, 6861234.0, 50.0);
  const Vector3d size(10.0, 8.0, 3.0);
  std::vector<Vector3d> points;
  for (std::size_t i = 0; i < count; ++i) {
    Vector3d x(random.uniform(), random.uniform(), random.uniform());
    const std::size_t side = i % 5;
    x[side < 4 ? static_cast<int>(side / 2) : 2] = side % 2 == 0 ? 0.0 : 1.0;
    points.emplace_back(corner + size.cwiseProduct(x));
  }
  points.insert(points.end(), of_one, corner + 0.37 * size);
  return points;
}

std::string written(const std::vector<Vector3d>& points) {
  const testing_io::TemporaryFolder folder;
  CloudPlan plan;
  for (const char* name : {"x", "y", "z", "gps_time"}) plan.columns.push_back({name, Scalar::float64});
  plan.near = {652345.0, 6861234.0, 50.0};
  plan.most_points = points.size();
  std::vector<double> rows;
  for (std::size_t i = 0; i < points.size(); ++i)
    rows.insert(rows.end(), {points[i].x(), points[i].y(), points[i].z(), 1000.0 + static_cast<double>(i)});
  RecordTable table;
  table.rows = points.size();
  for (std::size_t k = 0; k < 4; ++k)
    table.fields.push_back(
        {plan.columns[k].name, Scalar::float64, reinterpret_cast<const char*>(rows.data()) + 8 * k, 32});
  const auto writer = make_las_writer(folder / "room.copc.laz", plan);
  writer->write(table);
  writer->finish();
  return testing_io::slurp(folder / "room.copc.laz");
}

/// The sorted coordinates that a file stores.
std::vector<std::array<std::int32_t, 3>> sorted_places(const std::string& records, std::size_t bytes) {
  std::vector<std::array<std::int32_t, 3>> places(records.size() / bytes);
  for (std::size_t i = 0; i < places.size(); ++i)
    std::memcpy(places[i].data(), &records[i * bytes], sizeof places[i]);
  std::sort(places.begin(), places.end());
  return places;
}

TEST(CopcWriter, TheNameDecides) {
  EXPECT_TRUE(is_copc_ending("a/b.copc.laz"));
  EXPECT_TRUE(is_copc_ending("B.COPC.LAZ"));
  EXPECT_FALSE(is_copc_ending("copc.laz"));
  EXPECT_FALSE(is_copc_ending("b.copc.las"));
}

TEST(CopcWriter, NodesHoldTheirPointsAndAllOfThem) {
  const std::vector<Vector3d> points = room_points(90000, 25000);
  const Copc copc(written(points));
  EXPECT_EQ(copc.header.records.front().user, "copc");
  EXPECT_EQ(copc.header.records.front().begin, 375U);
  ASSERT_NE(copc.header.find("copc", 1000), nullptr);
  EXPECT_EQ(las_number<double>(copc.bytes, 429 + 56), 1000.0);
  EXPECT_EQ(las_number<double>(copc.bytes, 429 + 64), 1000.0 + 114999.0);
  EXPECT_NEAR(copc.spacing, 2.0 * copc.half / 128.0, 1e-12);

  // Every node is a chunk, and its parent is there.
  const LazInfo info = parse_laz_info(copc.bytes, "test", copc.header);
  ASSERT_EQ(info.chunks.size(), copc.nodes.size());
  std::map<std::uint64_t, std::uint64_t> chunk_points;
  for (const LazChunkPlace& chunk : info.chunks) chunk_points[chunk.begin] = chunk.points;
  std::int32_t sum = 0;
  int deepest = 0;
  for (const auto& [key, entry] : copc.nodes) {
    const auto [level, x, y, z] = key;
    EXPECT_EQ(chunk_points[entry.place], static_cast<std::uint64_t>(entry.points));
    EXPECT_GT(entry.points, 0);
    sum += entry.points;
    deepest = std::max(deepest, level);
    if (level > 0) {
      EXPECT_TRUE(copc.nodes.contains({level - 1, x / 2, y / 2, z / 2}));
    }
  }
  EXPECT_EQ(sum, 115000);
  EXPECT_EQ(deepest, 14);  // the point that is there so often

  // Every point lies in the cube of its node; a node with children has one of each cell.
  const auto records = open_las_records(copc.bytes, "test", copc.header);
  std::vector<Vector3d> read;
  for (LasPiece piece = records->next(1000); piece.count > 0; piece = records->next(1000)) {
    for (std::size_t i = 0; i < piece.count; ++i) {
      std::array<std::int32_t, 3> steps{};
      std::memcpy(steps.data(), piece.data + i * copc.header.point_bytes, sizeof steps);
      read.emplace_back(copc.header.offset +
                        copc.header.scale.cwiseProduct(Vector3d(steps[0], steps[1], steps[2])));
    }
  }
  ASSERT_EQ(read.size(), points.size());
  std::map<std::uint64_t, Key> by_place;
  for (const auto& [key, entry] : copc.nodes) by_place[entry.place] = key;
  std::size_t next = 0;
  for (const LazChunkPlace& chunk : info.chunks) {
    const auto [level, x, y, z] = by_place[chunk.begin];
    const double side = std::ldexp(2.0 * copc.half, -level);
    const Vector3d low = copc.centre - Vector3d::Constant(copc.half) + side * Vector3d(x, y, z);
    std::set<std::array<int, 3>> cells;
    for (std::uint64_t i = 0; i < chunk.points; ++i, ++next) {
      const Vector3d within = (read[next] - low) / side;
      EXPECT_GE(within.minCoeff(), -1e-6);
      EXPECT_LE(within.maxCoeff(), 1.0 + 1e-6);
      const Vector3d cell = within * 128.0;
      cells.insert({static_cast<int>(cell.x()), static_cast<int>(cell.y()), static_cast<int>(cell.z())});
    }
    if (level == 0) {
      EXPECT_GT(static_cast<double>(cells.size()), 0.98 * static_cast<double>(chunk.points));
    }
  }
}

TEST(CopcWriter, PointsAreThoseOfTheLazInAnyOrder) {
  const Copc copc(written(room_points(30000, 0)));
  const std::string records = testing_las::records_of(copc.bytes);
  const std::vector<Vector3d> points = room_points(30000, 0);
  std::vector<std::array<std::int32_t, 3>> wanted;
  for (const Vector3d& point : points) {
    const Vector3d steps = (point - copc.header.offset).cwiseQuotient(copc.header.scale);
    wanted.push_back({static_cast<std::int32_t>(std::nearbyint(steps.x())),
                      static_cast<std::int32_t>(std::nearbyint(steps.y())),
                      static_cast<std::int32_t>(std::nearbyint(steps.z()))});
  }
  std::sort(wanted.begin(), wanted.end());
  EXPECT_TRUE(sorted_places(records, copc.header.point_bytes) == wanted);
}

TEST(CopcWriter, FewPointsAndNone) {
  for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{3}}) {
    const Copc copc(written(room_points(count, 0)));
    EXPECT_EQ(copc.header.points, count);
    ASSERT_EQ(copc.nodes.size(), 1U);
    EXPECT_EQ(copc.nodes.begin()->first, Key(0, 0, 0, 0));
    EXPECT_EQ(copc.nodes.begin()->second.points, static_cast<std::int32_t>(count));
    EXPECT_GT(copc.half, 0.0);
  }
}

TEST(CopcWriter, TheSameBytesForAnyThreads) {
  const std::vector<Vector3d> points = room_points(100000, 0);
  set_thread_count(1);
  const std::string one = written(points);
  set_thread_count(0);
  EXPECT_TRUE(written(points) == one);
}

}  // namespace
}  // namespace limen
