// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/cloud/thin_cloud.h"

#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "support/test_support.h"
#include <gtest/gtest.h>

#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/io/table/table_stream.h"

namespace limen {
namespace {

using namespace testing_io;

/// x y z and the number of the row, of a room.
RecordTable room_table(std::size_t count) {
  auto numbers = std::make_shared<std::vector<double>>();
  const auto points = room_points(count, 7);
  for (std::size_t i = 0; i < count; ++i) {
    for (int k = 0; k < 3; ++k) numbers->push_back(points[i][k]);
    numbers->push_back(static_cast<double>(i));
  }
  return table_of_numbers(std::move(numbers), {"x", "y", "z", "number"});
}

ThinnedCloud thinned(const RecordTable& table, const ThinOptions& options, std::size_t piece = 100000) {
  CloudThinner thinner(options, table.rows);
  const auto stream = stream_of_table(table);
  while (const auto rows = stream->next(piece)) thinner.add(*rows);
  return thinner.finish();
}

std::vector<double> column(const RecordTable& table, const char* name) {
  std::vector<double> values(table.rows);
  load_numbers(table, *table.find({name}), {0, table.rows}, values.data());
  return values;
}

ThinOptions most(std::uint64_t points) {
  ThinOptions options;
  options.most_points = points;
  return options;
}

TEST(ThinCloud, KeepsNearlyAsManyPointsAsAskedFor) {
  const RecordTable table = room_table(300000);
  for (const std::uint64_t wanted : {300U, 5000U, 40000U, 123456U}) {
    const ThinnedCloud kept = thinned(table, most(wanted));
    EXPECT_LE(kept.table.rows, wanted);
    EXPECT_GE(static_cast<double>(kept.table.rows), 0.7 * static_cast<double>(wanted)) << wanted;
    EXPECT_EQ(kept.read, table.rows);
  }
}

/// The spacing of nearly as many points as there are is found too, and none are drawn by lot.
TEST(ThinCloud, ChoosesTheSpacingWhereMostPointsStay) {
  const RecordTable table = room_table(30000);
  for (const std::uint64_t wanted : {15000U, 25000U}) {
    const ThinnedCloud kept = thinned(table, most(wanted));
    ThinOptions spaced;
    spaced.spacing_m = kept.spacing_m;
    EXPECT_LE(thinned(table, spaced).table.rows, wanted + wanted / 20) << wanted;
  }
}

TEST(ThinCloud, WhatIsKeptIsInTheCloudAndInItsOrder) {
  const RecordTable table = room_table(50000);
  const ThinnedCloud kept = thinned(table, most(4000));
  const auto numbers = column(kept.table, "number");
  const auto x = column(kept.table, "x");
  const auto all = column(table, "x");
  ASSERT_EQ(kept.rows.size(), numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    EXPECT_EQ(static_cast<double>(kept.rows[i]), numbers[i]);
    ASSERT_EQ(x[i], all[kept.rows[i]]);
    ASSERT_TRUE(i == 0 || kept.rows[i - 1] < kept.rows[i]);
  }
}

TEST(ThinCloud, IsTheSameForAnyNumberOfThreads) {
  const RecordTable table = room_table(200000);
  const int before = thread_count();
  set_thread_count(1);
  const ThinnedCloud one = thinned(table, most(10000));
  set_thread_count(7);
  const ThinnedCloud seven = thinned(table, most(10000));
  set_thread_count(before);
  EXPECT_EQ(one.rows, seven.rows);
  EXPECT_EQ(one.spacing_m, seven.spacing_m);
}

TEST(ThinCloud, ASpacingGivesOnePointPerCubeWhateverThePieces) {
  const RecordTable table = room_table(100000);
  ThinOptions options;
  options.spacing_m = 0.25;
  const ThinnedCloud kept = thinned(table, options);
  EXPECT_EQ(kept.rows, thinned(table, options, 777).rows);
  EXPECT_EQ(kept.spacing_m, 0.25);
  // Every point has a kept one within the diagonal of a cube.
  std::set<std::tuple<int, int, int>> near;
  const auto place = [&](const RecordTable& from, std::size_t i) {
    Vector3d p;
    const char* const names[] = {"x", "y", "z"};
    for (int k = 0; k < 3; ++k) load_numbers(from, *from.find({names[k]}), {i, i + 1}, &p[k]);
    return p;
  };
  std::vector<Vector3d> left;
  for (std::size_t i = 0; i < kept.table.rows; ++i) left.push_back(place(kept.table, i));
  for (std::size_t i = 0; i < table.rows; i += 997) {
    const Vector3d p = place(table, i);
    double nearest = 1e9;
    for (const Vector3d& q : left) nearest = std::min(nearest, (p - q).norm());
    ASSERT_LE(nearest, 0.25 * std::sqrt(3.0));
  }
}

TEST(ThinCloud, ASpacingBelowWhatNumbersTellApartIsRefused) {
  ThinOptions options;
  for (const double spacing_m : {1e-19, 1e-300, -0.1}) {
    options.spacing_m = spacing_m;
    EXPECT_THROW(options.check(), Error) << spacing_m;
  }
}

TEST(ThinCloud, NoLatticeShows) {
  // A dense plane: what is kept must lie anywhere within its cubes, not at one side of them.
  auto numbers = std::make_shared<std::vector<double>>();
  for (int i = 0; i < 400; ++i) {
    for (int j = 0; j < 400; ++j) numbers->insert(numbers->end(), {0.005 * i, 0.005 * j, 1.0});
  }
  ThinOptions options;
  options.spacing_m = 0.1;
  const ThinnedCloud kept = thinned(table_of_numbers(numbers, {"x", "y", "z"}), options);
  std::map<int, int> histogram;
  for (const double x : column(kept.table, "x"))
    ++histogram[static_cast<int>(std::fmod(x + 1e-9, 0.1) / 0.025)];
  for (const auto& [bin, count] : histogram)
    EXPECT_NEAR(count, static_cast<double>(kept.table.rows) / 4, 40) << bin;
  EXPECT_EQ(histogram.size(), 4U);
}

TEST(ThinCloud, LeavesOutWhatHasNoCoordinates) {
  const double nan = std::nan("");
  const auto numbers =
      std::make_shared<std::vector<double>>(std::vector<double>{nan, 0, 0, 1, 2, 3, 1, 1e12, 0});
  const ThinnedCloud kept = thinned(table_of_numbers(numbers, {"x", "y", "z"}), most(10));
  EXPECT_EQ(kept.unusable, 2U);
  EXPECT_EQ(kept.rows, (std::vector<std::uint64_t>{1}));
}

TEST(ThinCloud, StaysWithinItsMemory) {
  ThinOptions options;
  options.memory_bytes = 1000000;
  const ThinnedCloud kept = thinned(room_table(200000), options);
  EXPECT_LE(kept.table.rows, 1000000U / (40 + 32));
  EXPECT_GE(kept.table.rows, 3000U);
}

TEST(ThinCloud, AsksForSomething) {
  EXPECT_THROW(ThinOptions{}.check(), Error);
  EXPECT_THROW(CloudThinner(most(0), 1), Error);
  CloudThinner thinner(most(5), 2);
  const auto numbers = std::make_shared<std::vector<double>>(std::vector<double>{1, 2});
  EXPECT_THROW(thinner.add(table_of_numbers(numbers, {"x", "y"})), Error);
}

}  // namespace
}  // namespace limen
