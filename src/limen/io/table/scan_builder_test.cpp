// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/table/scan_builder.h"

#include <limits>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "limen/base/error.h"
#include "limen/base/random.h"

namespace limen {
namespace {

const std::vector<std::string> kNames = {"x",   "y",     "z",    "gps_time",  "intensity",
                                         "red", "green", "blue", "scan_line", "scan_index"};

std::vector<double> numbers(std::size_t rows) {
  RandomStream random(4, 0);
  std::vector<double> all;
  for (std::size_t i = 0; i < rows; ++i) {
    for (int k = 0; k < 3; ++k) all.push_back(6840000.0 + random.uniform(0.0, 20.0));
    all.push_back(100.0 + 0.001 * static_cast<double>(i));
    all.push_back(random.uniform());
    for (int k = 0; k < 3; ++k) all.push_back(random.uniform(0.0, 65535.0));
    all.push_back(static_cast<double>(i / 100));
    all.push_back(static_cast<double>(i % 100));
  }
  return all;
}

RecordTable table_of(const std::vector<double>& all, std::size_t begin, std::size_t end) {
  const auto at = [&](std::size_t row) {
    return all.begin() + static_cast<std::ptrdiff_t>(row * kNames.size());
  };
  return table_of_numbers(std::make_shared<const std::vector<double>>(at(begin), at(end)), kNames);
}

TableFacts facts() {
  TableFacts facts;
  facts.name = "test";
  return facts;
}

TEST(ScanBuilder, TablesOneByOneMakeTheScanOfOneTable) {
  std::vector<double> all = numbers(3000);
  all[kNames.size() * 1234] = std::numeric_limits<double>::quiet_NaN();
  // The first table holds no usable point at all.
  for (std::size_t row = 0; row < 500; ++row) all[kNames.size() * row] = 1e30;
  const ScanFile whole = with_scan({}, table_of(all, 0, 3000), facts(), {});
  ScanBuilder builder(facts(), {});
  builder.reserve(3000);
  for (const std::size_t begin : {0U, 500U, 1100U, 1101U})
    builder.add(table_of(all, begin, begin == 0 ? 500 : begin == 500 ? 1100 : begin == 1100 ? 1101 : 3000));
  const ScanFile pieces = builder.finish({});
  ASSERT_EQ(whole.scans.size(), 1U);
  const Scan& a = whole.scans.front();
  const Scan& b = pieces.scans.front();
  EXPECT_EQ(a.size(), 2499U);
  EXPECT_EQ(a.local_origin, b.local_origin);
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.times_s, b.times_s);
  EXPECT_EQ(a.intensities, b.intensities);
  EXPECT_EQ(a.colours, b.colours);
  EXPECT_EQ(a.topology.line, b.topology.line);
  EXPECT_EQ(a.topology.index, b.topology.index);
  EXPECT_EQ(whole.dropped, pieces.dropped);
  EXPECT_EQ(whole.notes, pieces.notes);
}

TEST(ScanBuilder, PointsWithoutAScannerPositionAreKeptIfTheyAreMany) {
  const std::vector<std::string> names = {"x", "y", "z", "x_origin", "y_origin", "z_origin"};
  const auto scan_with = [&](std::size_t missing, bool returns = false, bool still = false) {
    RandomStream random(5, 0);
    std::vector<double> all;
    for (std::size_t i = 0; i < 1000; ++i) {
      const double none = std::numeric_limits<double>::quiet_NaN();
      for (int k = 0; k < 3; ++k) all.push_back(returns && i < missing ? none : random.uniform(0.0, 20.0));
      for (int k = 0; k < 3; ++k) all.push_back(i < missing ? none : still ? 9.5 : random.uniform(9.0, 10.0));
    }
    return with_scan({}, table_of_numbers(std::make_shared<const std::vector<double>>(all), names), facts(),
                     {});
  };
  const ScanFile few = scan_with(5);
  EXPECT_EQ(few.scans.front().size(), 995U);
  EXPECT_TRUE(few.scans.front().mobile());
  const ScanFile half = scan_with(500);
  EXPECT_EQ(half.scans.front().size(), 1000U);
  EXPECT_FALSE(half.scans.front().centre_known());
  EXPECT_EQ(half.unusable, 0U);
  EXPECT_EQ(half.notes.back(),
            "500 of 1000 points state no scanner position; it is taken as unknown for all");
  // That of a station is not that of the scan it was merged with.
  const ScanFile merged = scan_with(500, false, true);
  EXPECT_EQ(merged.scans.front().size(), 1000U);
  EXPECT_FALSE(merged.scans.front().centre_known());
  const ScanFile station = scan_with(5, false, true);
  EXPECT_EQ(station.scans.front().size(), 1000U);
  EXPECT_EQ(station.scans.front().centres.size(), 1U);
  // A missing return has no position either, and says nothing of the others.
  const ScanFile returns = scan_with(500, true);
  EXPECT_EQ(returns.scans.front().size(), 500U);
  EXPECT_TRUE(returns.scans.front().mobile());
}

TEST(ScanBuilder, LineNumbersThatAreNoneAreNotBelieved) {
  std::vector<double> all = numbers(100);
  all[kNames.size() * 50 + 8] = 1e12;
  EXPECT_FALSE(with_scan({}, table_of(all, 0, 100), facts(), {}).scans.front().topology.known());
  EXPECT_TRUE(with_scan({}, table_of(all, 0, 50), facts(), {}).scans.front().topology.known());
}

TEST(ScanBuilder, WithoutAnythingUsableThereIsNoScan) {
  std::vector<double> all = numbers(10);
  for (std::size_t row = 0; row < 10; ++row) all[kNames.size() * row] = 1e30;
  EXPECT_THROW(with_scan({}, table_of(all, 0, 10), facts(), {}), Error);
  EXPECT_THROW(ScanBuilder(facts(), {}).finish({}), Error);
}

TEST(ScanBuilder, PointsThatAllLieInOnePlaceAreNoScan) {
  std::vector<double> all = numbers(100);
  for (std::size_t row = 0; row < 100; ++row) {
    for (std::size_t k = 0; k < 3; ++k) all[kNames.size() * row + k] = 2.0;
  }
  EXPECT_THROW(with_scan({}, table_of(all, 0, 100), facts(), {}), Error);
  EXPECT_NO_THROW(with_scan({}, table_of(all, 0, 1), facts(), {}));
  all[0] = 2.5;
  EXPECT_NO_THROW(with_scan({}, table_of(all, 0, 100), facts(), {}));
}

}  // namespace
}  // namespace limen
