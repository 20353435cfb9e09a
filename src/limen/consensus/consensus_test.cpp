// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include "limen/consensus/msac.h"

namespace limen {
namespace {

/// Lines y = a + b x through points of the plane, some of which stand for several.
struct LineEstimator {
  struct Model {
    double a = 0.0;
    double b = 0.0;
  };
  static constexpr std::size_t kSampleSize = 2;
  std::vector<double> x;
  std::vector<double> y;

  [[nodiscard]] std::size_t size() const { return x.size(); }
  [[nodiscard]] std::optional<Model> estimate(const std::array<std::uint32_t, 2>& sample) const {
    const double dx = x[sample[1]] - x[sample[0]];
    if (std::abs(dx) < 1e-9) return std::nullopt;
    const double b = (y[sample[1]] - y[sample[0]]) / dx;
    return Model{y[sample[0]] - b * x[sample[0]], b};
  }
  [[nodiscard]] double residual(const Model& model, std::uint32_t i) const {
    return std::abs(model.a + model.b * x[i] - y[i]);
  }
};

/// 300 points on y = 1 + 2 x within 0.01, and 700 anywhere.
LineEstimator line_in_noise() {
  LineEstimator points;
  RandomStream random(3);
  for (int i = 0; i < 1000; ++i) {
    const double x = random.uniform(0.0, 10.0);
    points.x.push_back(x);
    points.y.push_back(i % 10 < 3 ? 1.0 + 2.0 * x + random.uniform(-0.01, 0.01) : random.uniform(0.0, 20.0));
  }
  return points;
}

TEST(TrialCount, FollowsFromTheRatio) {
  // 1 - (1 - 0.5^3)^n >= 0.99
  EXPECT_EQ(trial_count(0.5, 3, 0.99, 1000), 35U);
  EXPECT_EQ(trial_count(1.0, 3, 0.99, 1000), 1U);
  EXPECT_EQ(trial_count(0.0, 3, 0.99, 1000), 1000U);
  EXPECT_EQ(trial_count(-1.0, 3, 0.99, 7), 7U);
  EXPECT_EQ(trial_count(2.0, 3, 0.99, 7), 1U);
  EXPECT_EQ(trial_count(1e-3, 3, 0.99, 100000000000), 4605170184U);
  EXPECT_THROW(trial_count(0.5, 3, 1.0, 10), Error);
}

TEST(UniformSampler, DrawsEachItemOnceAndEvenly) {
  const UniformSampler sampler(5, 9);
  std::array<int, 5> drawn{};
  for (std::uint64_t trial = 0; trial < 5000; ++trial) {
    const auto sample = sampler.sample<3>(trial);
    EXPECT_NE(sample[0], sample[1]);
    EXPECT_NE(sample[0], sample[2]);
    EXPECT_NE(sample[1], sample[2]);
    for (const std::uint32_t item : sample) ++drawn.at(item);
    EXPECT_EQ(sample, sampler.sample<3>(trial));
  }
  for (const int count : drawn) EXPECT_NEAR(count, 3000, 150);
}

TEST(Msac, FindsTheLineAmongOutliers) {
  const LineEstimator points = line_in_noise();
  const auto found = msac(points, UniformSampler(points.size(), 1), {.threshold = 0.03});
  ASSERT_TRUE(found.model);
  EXPECT_NEAR(found.model->a, 1.0, 0.03);
  EXPECT_NEAR(found.model->b, 2.0, 0.005);
  EXPECT_EQ(found.judged, 1000.0);
  EXPECT_GT(found.score, 240.0);
  EXPECT_LT(found.score, 310.0);
  // 30 % inliers need 49 trials: two rounds, and far from the limit.
  EXPECT_GE(found.trials, 49U);
  EXPECT_LE(found.trials, 200U);
}

TEST(Msac, ScoreIsThatOfTheEquation) {
  LineEstimator points;
  points.x = {0.0, 1.0, 2.0, 3.0};
  points.y = {0.0, 0.5, 0.0, 2.0};
  EXPECT_DOUBLE_EQ(score_of(points, {0.0, 0.0}, MsacScore{1.0}, 4.0), 1.0 + 0.75 + 1.0 + 0.0);
}

struct WeightedLine : LineEstimator {
  [[nodiscard]] double weight(std::uint32_t item) const { return item < 3 ? 10.0 : 1.0; }
};

TEST(Msac, WeightsDecide) {
  WeightedLine points;
  for (int i = 0; i < 12; ++i) {
    points.x.push_back(i);
    points.y.push_back(i < 3 ? 0.0 : 5.0);
  }
  const auto found = msac(points, UniformSampler(points.size(), 2), {.threshold = 0.5});
  ASSERT_TRUE(found.model);
  EXPECT_NEAR(found.model->a, 0.0, 1e-12);
  EXPECT_DOUBLE_EQ(found.score, 30.0);
  EXPECT_DOUBLE_EQ(found.judged, 39.0);
}

TEST(Msac, DoesNotDependOnThreads) {
  const LineEstimator points = line_in_noise();
  const auto run = [&](int threads) {
    set_thread_count(threads);
    const auto found = msac(points, UniformSampler(points.size(), 4), {.threshold = 0.03, .judges = 400});
    set_thread_count(0);
    return found;
  };
  const auto one = run(1);
  const auto four = run(4);
  ASSERT_TRUE(one.model && four.model);
  EXPECT_EQ(one.model->a, four.model->a);
  EXPECT_EQ(one.model->b, four.model->b);
  EXPECT_EQ(one.trials, four.trials);
  EXPECT_EQ(one.judged, 500.0);  // every second item
}

TEST(Msac, OfDegenerateItemsIsNothing) {
  LineEstimator points;
  EXPECT_FALSE(msac(points, UniformSampler(0, 1), {}).model);
  points.x = {1.0, 1.0, 1.0};
  points.y = {1.0, 2.0, 3.0};
  const auto found = msac(points, UniformSampler(3, 1), {.most_trials = 40});
  EXPECT_FALSE(found.model);
  EXPECT_EQ(found.trials, 40U);
  EXPECT_THROW(msac(points, UniformSampler(3, 1), {.threshold = 0.0}), Error);
}

}  // namespace
}  // namespace limen
