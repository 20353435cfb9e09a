// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/planes/plane_labels.h"

#include <gtest/gtest.h>

namespace limen {
namespace {

TEST(PointsOf, ListsThePointsOfEachPlane) {
  const auto points = points_of({1, -1, 0, 1, 1}, 3);
  ASSERT_EQ(points.size(), 3U);
  EXPECT_EQ(points[0], (std::vector<std::uint32_t>{2}));
  EXPECT_EQ(points[1], (std::vector<std::uint32_t>{0, 3, 4}));
  EXPECT_TRUE(points[2].empty());
}

}  // namespace
}  // namespace limen
