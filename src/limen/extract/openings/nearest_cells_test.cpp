// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "limen/base/random.h"
#include "limen/extract/openings/opening_grid.h"

namespace limen {
namespace {

TEST(NearestCells, NothingIsKnownWhereNoCellIsOfTheKind) {
  const NearestCells nearest(7, 5, [](int, int) { return false; });
  for (int r = 0; r < 5; ++r) {
    for (int c = 0; c < 7; ++c) EXPECT_FALSE(nearest.from(c, r).known());
  }
}

TEST(NearestCells, TheWayToTheOnlyCell) {
  const NearestCells nearest(9, 4, [](int c, int r) { return c == 6 && r == 1; });
  for (int r = 0; r < 4; ++r) {
    for (int c = 0; c < 9; ++c) {
      ASSERT_TRUE(nearest.from(c, r).known());
      EXPECT_EQ(c + nearest.from(c, r).columns, 6);
      EXPECT_EQ(r + nearest.from(c, r).rows, 1);
    }
  }
}

TEST(NearestCells, AsNearAsTheNearestOfAll) {
  constexpr int kColumns = 31;
  constexpr int kRows = 23;
  RandomStream stream(5);
  std::array<std::array<bool, kColumns>, kRows> ones{};
  for (auto& row : ones) {
    for (bool& one : row) one = stream.below(20) == 0;
  }
  const NearestCells nearest(kColumns, kRows, [&](int c, int r) {
    return ones[static_cast<std::size_t>(r)][static_cast<std::size_t>(c)];
  });
  for (int r = 0; r < kRows; ++r) {
    for (int c = 0; c < kColumns; ++c) {
      std::int64_t least = std::numeric_limits<std::int64_t>::max();
      for (int y = 0; y < kRows; ++y) {
        for (int x = 0; x < kColumns; ++x) {
          if (ones[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)])
            least = std::min<std::int64_t>(least, (x - c) * (x - c) + (y - r) * (y - r));
        }
      }
      const NearestCells::Way& way = nearest.from(c, r);
      EXPECT_TRUE(ones[static_cast<std::size_t>(r + way.rows)][static_cast<std::size_t>(c + way.columns)]);
      EXPECT_LE(std::sqrt(static_cast<double>(way.squared())), std::sqrt(static_cast<double>(least)) + 0.3);
    }
  }
}

}  // namespace
}  // namespace limen
