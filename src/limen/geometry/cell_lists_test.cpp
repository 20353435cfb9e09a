// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/geometry/cell_lists.h"

#include <cmath>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "limen/base/random.h"
#include "limen/geometry/cell_key.h"
#include "limen/geometry/polygon.h"

namespace limen {
namespace {

TEST(CellLists, TellsWhatAMapOfListsTells) {
  RandomStream random(3, 1);
  std::vector<std::vector<std::int64_t>> cells_of(40);
  std::map<std::int64_t, std::vector<std::int32_t>> expected;
  for (std::size_t k = 0; k < cells_of.size(); ++k) {
    for (int i = 0; i < 200; ++i) {
      const Vector3d whole(std::floor(20.0 * random.uniform()) - 10.0, std::floor(9.0 * random.uniform()),
                           -3.0);
      const std::int64_t cell = cell_key(whole);
      std::vector<std::int32_t>& there = expected[cell];
      if (!there.empty() && there.back() == static_cast<std::int32_t>(k)) continue;
      there.push_back(static_cast<std::int32_t>(k));
      cells_of[k].push_back(cell);
    }
  }
  const CellLists lists(cells_of);
  for (const auto& [cell, things] : expected) {
    const std::span<const std::int32_t> found = lists.at(cell);
    EXPECT_EQ(std::vector<std::int32_t>(found.begin(), found.end()), things);
  }
  EXPECT_TRUE(lists.at(cell_key({500.0, 0.0, 0.0})).empty());
  EXPECT_TRUE(CellLists().at(7).empty());
  EXPECT_TRUE(CellLists(std::vector<std::vector<std::int64_t>>{}).at(7).empty());
}

TEST(Crossings, TellTheSameAsContains) {
  RandomStream random(5, 1);
  const Polygon polygon{{{0, 0}, {6, 0}, {6, 1}, {2, 1}, {2, 4}, {6, 4}, {5, 6}, {0, 6}},
                        {{{0.5, 0.5}, {0.5, 3.0}, {1.5, 2.0}}, {{1.0, 4.5}, {1.0, 5.5}, {4.0, 5.0}}}};
  for (int k = 0; k < 2000; ++k) {
    // Corners' own heights among them.
    const double y =
        k % 4 == 0 ? 0.5 * std::floor(14.0 * random.uniform() - 1.0) : 7.0 * random.uniform() - 0.5;
    const double x =
        k % 5 == 0 ? 0.5 * std::floor(14.0 * random.uniform() - 1.0) : 7.0 * random.uniform() - 0.5;
    std::size_t beyond = 0;
    for (const double crossing : crossings(polygon, y)) beyond += crossing > x ? 1 : 0;
    EXPECT_EQ(beyond % 2 == 1, contains(polygon, {x, y})) << x << " " << y;
  }
}

}  // namespace
}  // namespace limen
