// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/geometry/spline_motion.h"

#include <gtest/gtest.h>

#include "limen/base/random.h"

namespace limen {
namespace {

std::vector<Vector6d> random_values(std::size_t count, double size) {
  RandomStream random(3);
  std::vector<Vector6d> values(count);
  for (Vector6d& value : values) {
    for (Eigen::Index k = 0; k < 6; ++k) value[k] = size * random.normal();
  }
  return values;
}

TEST(SplineMotion, GoesThroughItsKnotsAndStaysBeyondTheEnds) {
  for (const std::size_t knots : {2U, 3U, 4U, 9U}) {
    std::vector<double> times;
    for (std::size_t k = 0; k < knots; ++k) times.push_back(1.0 + 2.0 * static_cast<double>(k * k));
    const std::vector<Vector6d> values = random_values(knots, 0.01);
    const SplineMotion motion(times, values, {10, 20, 30});
    for (std::size_t k = 0; k < knots; ++k)
      EXPECT_LT((motion.value(times[k]) - values[k]).norm(), 1e-15) << knots << " " << k;
    EXPECT_EQ(motion.value(times.front() - 5.0), motion.value(times.front()));
    EXPECT_EQ(motion.value(times.back() + 5.0), motion.value(times.back()));
  }
}

TEST(SplineMotion, IsSmoothAndNaturalAtItsEnds) {
  std::vector<double> times;
  for (int k = 0; k < 7; ++k) times.push_back(k);
  const SplineMotion motion(times, random_values(7, 1.0), Vector3d::Zero());
  constexpr double kStep = 1e-3;
  const auto bend = [&](double t) {
    return Vector6d((motion.value(t + kStep) - 2.0 * motion.value(t) + motion.value(t - kStep)) /
                    (kStep * kStep));
  };
  // At inner knots the second derivative is the same from both sides; at the ends it is nothing.
  for (int k = 1; k < 6; ++k) EXPECT_LT((bend(k - 1.5 * kStep) - bend(k + 1.5 * kStep)).norm(), 0.2) << k;
  EXPECT_LT(bend(kStep).norm(), 0.1);
  EXPECT_LT(bend(6.0 - kStep).norm(), 0.1);
  EXPECT_GT(bend(2.5).norm(), 0.5);
}

TEST(SplineMotion, ALineStaysALine) {
  std::vector<Vector6d> values;
  std::vector<double> times;
  const Vector6d slope = random_values(1, 1.0).front();
  for (int k = 0; k < 6; ++k) {
    times.push_back(10.0 * k);
    values.emplace_back(k * slope);
  }
  const SplineMotion motion(times, values, Vector3d::Zero());
  for (const double t : {0.0, 3.0, 17.5, 44.0, 50.0})
    EXPECT_LT((motion.value(t) - t / 10.0 * slope).norm(), 1e-12) << t;
}

TEST(SplineMotion, MovesFarPointsToTheMicrometre) {
  const Vector3d pivot(652345.0, 6862123.0, 35.0);
  const SplineMotion motion({0.0, 1.0}, {Vector6d::Constant(1e-4), Vector6d::Constant(2e-4)}, pivot);
  const Vector3d x = pivot + Vector3d(30.0, -20.0, 4.0);
  EXPECT_LT((motion.moved(x, 0.3) - motion.at(0.3) * x).norm(), 1e-6);
  const Vector6d now = motion.value(0.3);
  const Vector3d expected = x + now.tail<3>() + now.head<3>().cross(x - pivot);
  EXPECT_LT((motion.moved(x, 0.3) - expected).norm(), 1e-6);
}

TEST(SplineMotion, SharesAreOneInAll) {
  for (const int knots : {2, 3, 5, 40}) {
    for (double place = 0.0; place <= knots - 1; place += 0.21) {
      double sum = 0.0;
      for (const SplineShare& share : spline_shares(knots, place)) {
        ASSERT_GE(share.control, 0);
        ASSERT_LT(share.control, knots);
        sum += share.weight;
      }
      EXPECT_NEAR(sum, 1.0, 1e-14);
    }
  }
}

}  // namespace
}  // namespace limen
