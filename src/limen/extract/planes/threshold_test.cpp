// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "limen/extract/planes/automatic_threshold.h"

namespace limen {
namespace {

double choose(int n, int k) {
  double value = 1.0;
  for (int i = 1; i <= k; ++i) value *= static_cast<double>(n - k + i) / i;
  return value;
}

TEST(PublishedNfa, IsTheSumOfEquationSix) {
  ThresholdOptions options;
  options.thresholds_m = {0.01, 0.02};
  options.min_inliers = 100;
  const CloudSize cloud{1099, Vector3d(4.0, 5.0, 3.0)};  // R = 10
  const double p = 2.0 * 0.01 * 50.0 / 60.0;
  for (const int planes : {1, 2, 4, 5}) {
    const int missed = 10 - planes;
    double sum = 0.0;
    for (int j = planes; j <= missed; ++j)
      sum += choose(missed, j) * std::pow(p, j) * std::pow(1.0 - p, missed - j);
    EXPECT_NEAR(published_log10_nfa(cloud, static_cast<std::size_t>(planes), 0.01, options),
                std::log10(2.0 * sum), 1e-9)
        << planes;
  }
  // More found than missed: the printed sum is empty. No plane at all: certain.
  EXPECT_EQ(published_log10_nfa(cloud, 6, 0.01, options), -INFINITY);
  EXPECT_NEAR(published_log10_nfa(cloud, 0, 0.01, options), std::log10(2.0), 1e-12);
  // A slab larger than the cloud: P is clamped to 1.
  EXPECT_NEAR(published_log10_nfa(cloud, 2, 0.75, options), std::log10(2.0), 1e-12);
}

TEST(PublishedNfa, SurvivesLargeClouds) {
  const CloudSize cloud{3000000, Vector3d(50.0, 50.0, 20.0)};  // R = 15 000: the terms underflow
  const double nfa = published_log10_nfa(cloud, 5000, 0.02, {});
  EXPECT_TRUE(std::isfinite(nfa));
  EXPECT_LT(nfa, -300.0);
}

TEST(PlaneNfa, BoundsTheBinomialTail) {
  ThresholdOptions options;
  options.thresholds_m = {0.1};
  const CloudSize cloud{103, Vector3d(1.0, 1.0, 1.0)};
  const DetectedPlane plane{63, 1.0};
  double tail = 0.0;
  for (int j = 60; j <= 100; ++j) tail += choose(100, j) * std::pow(0.2, j) * std::pow(0.8, 100 - j);
  const double tests = std::log10(103.0 * 102.0 * 101.0 / 6.0);
  const double bound = plane_log10_nfa(cloud, plane, 0.1, options);
  EXPECT_GE(bound, std::log10(tail) + tests);
  EXPECT_LT(bound, std::log10(tail) + tests + 1.5);
  // As many points as chance puts there mean nothing.
  EXPECT_NEAR(plane_log10_nfa(cloud, {20, 1.0}, 0.1, options), tests, 1e-9);
}

/// Walls with Gaussian noise: a threshold finds the share of their points within it, and below half the noise
/// the walls fall into pieces.
std::vector<DetectedPlane> walls_with_noise(double noise_m, double threshold_m) {
  const double share = std::erf(threshold_m / noise_m / std::numbers::sqrt2);
  return std::vector<DetectedPlane>(6, {static_cast<std::size_t>(20000.0 * share), 12.0});
}

TEST(ChooseThreshold, FollowsTheNoise) {
  const CloudSize cloud{140000, Vector3d(5.0, 4.0, 3.0)};
  for (const double noise_m : {0.003, 0.006, 0.012}) {
    const auto choice = choose_threshold(cloud, [&](double t) { return walls_with_noise(noise_m, t); });
    EXPECT_GE(choice.threshold_m, 1.2 * noise_m);
    EXPECT_LE(choice.threshold_m, 3.5 * noise_m);
    EXPECT_EQ(choice.scores.size(), 6U);
  }
}

TEST(ChooseThreshold, PrefersNotToFuseParallelWalls) {
  // 4 mm of noise; from 3 cm on, walls 5 cm apart are taken for one.
  const CloudSize cloud{140000, Vector3d(5.0, 4.0, 3.0)};
  const auto choice = choose_threshold(cloud, [](double t) {
    auto planes = walls_with_noise(0.004, t);
    if (t >= 0.03) planes.assign(3, {40000, 12.0});
    return planes;
  });
  EXPECT_LE(choice.threshold_m, 0.015);
}

TEST(ChooseThreshold, StopsOnceItGetsWorseIfAsked) {
  const CloudSize cloud{140000, Vector3d(5.0, 4.0, 3.0)};
  const auto detector = [](double t) { return walls_with_noise(0.004, t); };
  ThresholdOptions options;
  const ThresholdChoice all = choose_threshold(cloud, detector, options);
  options.until_worse = true;
  const ThresholdChoice few = choose_threshold(cloud, detector, options);
  EXPECT_EQ(few.threshold_m, all.threshold_m);
  EXPECT_LT(few.scores.size(), all.scores.size());
  // The last one tried is the first that is worse.
  ASSERT_GE(few.scores.size(), 2U);
  EXPECT_EQ(few.scores[few.scores.size() - 2].threshold_m, few.threshold_m);
}

TEST(ChooseThreshold, BreaksTies) {
  const CloudSize cloud{100000, Vector3d(5.0, 4.0, 3.0)};
  const auto nothing = choose_threshold(cloud, [](double) { return std::vector<DetectedPlane>{}; });
  EXPECT_EQ(nothing.threshold_m, 0.005);
  ThresholdOptions published;
  published.criterion = ThresholdCriterion::published;
  const auto most = choose_threshold(
      cloud,
      [](double t) {
        return std::vector<DetectedPlane>(t == 0.02 ? 400 : 300, {200, 1.0});
      },
      published);
  EXPECT_EQ(most.threshold_m, 0.02);
}

}  // namespace
}  // namespace limen
