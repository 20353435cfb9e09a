// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/frame/steady_sample.h"

#include <cstddef>
#include <set>

#include <gtest/gtest.h>

namespace limen {
namespace {

/// However small a share of a dense scan is chosen, its walls must not become a few circles.
TEST(SteadySample, OfADenseScanIsSpreadOut) {
  Scan scan;
  constexpr std::size_t kSide = 1000;
  for (std::size_t i = 0; i < kSide; ++i) {
    for (std::size_t j = 0; j < kSide; ++j)
      scan.points.emplace_back(3.0, 4.0 * static_cast<double>(i) / kSide,
                               4.0 * static_cast<double>(j) / kSide);
  }
  std::set<int> rings;  // of 20 cm about the middle, 14 of them
  const auto chosen = steady_sample(scan, 2000);
  for (const auto i : chosen)
    rings.insert(static_cast<int>((scan.points[i] - Vector3d(3.0, 2.0, 2.0)).norm() / 0.2));
  EXPECT_GT(chosen.size(), 1000U);
  EXPECT_LT(chosen.size(), 4000U);
  EXPECT_GE(rings.size(), 12U);
}

}  // namespace
}  // namespace limen
