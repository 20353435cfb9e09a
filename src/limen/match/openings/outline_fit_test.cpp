// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/match/openings/outline_fit.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "limen/base/random.h"

namespace limen {
namespace {

constexpr double kGrowthSigmaM = 0.05;

/// A window with a semicircular head (or an elliptic one), its foot in the middle of (0, 0), grown all round.
Ring arch(double width, double height, double rise, double growth = 0.0) {
  const double half = 0.5 * width + growth;
  const double spring = height - rise;
  Ring ring = {{-half, -growth}, {half, -growth}};
  for (int k = 0; k <= 16; ++k) {
    const double angle = std::numbers::pi * k / 16;
    ring.emplace_back(half * std::cos(angle), spring + (rise + growth) * std::sin(angle));
  }
  return ring;
}

Ring moved(Ring ring, const Vector2d& by) {
  for (Vector2d& p : ring) p += by;
  return ring;
}

Ring noisy(Ring ring, std::uint64_t seed) {
  RandomStream random(seed);
  for (Vector2d& p : ring) p += 0.01 * Vector2d(random.normal(), random.normal());
  return ring;
}

TEST(OutlineFit, FindsTheShiftOfAnArchAndItsGrowth) {
  const Vector2d shift(0.06, -0.04);
  const auto fit = fit_outlines(moved(arch(1.0, 1.8, 0.5), -shift), arch(1.0, 1.8, 0.5, 0.03), kGrowthSigmaM);
  ASSERT_TRUE(fit);
  EXPECT_LT((fit->shift_m - shift).norm(), 0.003);
  EXPECT_NEAR(fit->growth_m, 0.03, 0.006);
  EXPECT_LT(fit->rms_m, 0.01);
}

TEST(OutlineFit, TheCrownHoldsTheHeightAsWellAsItSays) {
  double worst = 0.0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const auto fit = fit_outlines(noisy(moved(arch(1.0, 1.8, 0.5), {0.05, 0.05}), seed),
                                  noisy(arch(1.0, 1.8, 0.5), 99 + seed), kGrowthSigmaM);
    ASSERT_TRUE(fit);
    const Vector2d off = fit->shift_m + Vector2d(0.05, 0.05);
    EXPECT_LT(fit->sigma_m.maxCoeff(), 0.02);
    worst = std::max({worst, std::abs(off.x()) / fit->sigma_m.x(), std::abs(off.y()) / fit->sigma_m.y()});
  }
  EXPECT_LT(worst, 3.5);
}

TEST(OutlineFit, AnotherShapeIsLeftOver) {
  const auto round = [] {
    Ring ring;
    for (int k = 0; k < 32; ++k)
      ring.emplace_back(0.5 * std::cos(std::numbers::pi * k / 16),
                        0.9 + 0.5 * std::sin(std::numbers::pi * k / 16));
    return ring;
  }();
  EXPECT_GT(fit_outlines(arch(1.0, 1.4, 0.5), round, kGrowthSigmaM)->rms_m, 0.05);
  EXPECT_GT(
      fit_outlines(arch(1.2, 2.0, 0.6), {{-0.6, 0.0}, {0.6, 0.0}, {0.6, 2.0}, {-0.6, 2.0}}, kGrowthSigmaM)
          ->rms_m,
      0.04);
  EXPECT_LT(fit_outlines(round, moved(round, {0.1, 0.1}), kGrowthSigmaM)->rms_m, 0.01);
  EXPECT_FALSE(fit_outlines({}, round, kGrowthSigmaM));
}

}  // namespace
}  // namespace limen
