// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/table/profile_topology.h"

#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

#include <gtest/gtest.h>

#include "limen/base/random.h"

namespace limen {
namespace {

/// Echoes of a mirror that turns all the time and the truth about each.
struct Profiler {
  std::vector<double> theta;
  std::vector<double> times;
  std::vector<int> line;
  std::vector<int> pulse;  ///< within the turn
};

constexpr int kPulses = 1000;  ///< per turn
constexpr int kTurns = 30;

/// Pulses in a sector of the sky give no echo, some others neither; some give two or three. Turn 11 sees
/// nothing at all.
Profiler simulate(bool falling, std::uint64_t seed) {
  RandomStream random(seed);
  Profiler out;
  for (int n = 0; n < kPulses * kTurns; ++n) {
    const int turn = n / kPulses;
    const int pulse = n % kPulses;
    if (turn == 11 || pulse < 150 || pulse > 850 || random.uniform() < 0.1) continue;
    const int echoes = random.uniform() < 0.05 ? 3 : 1;
    const double jitter = random.uniform(-0.04, 0.04);
    const double angle = 2.0 * std::numbers::pi * ((pulse + jitter) / kPulses - 0.5);
    for (int echo = 0; echo < echoes; ++echo) {
      out.theta.push_back(falling ? -angle : angle);
      out.times.push_back(54000.0 + 3.4e-6 * n);
      out.line.push_back(turn);
      out.pulse.push_back(pulse);
    }
  }
  return out;
}

void expect_truth(const Profiler& truth, const ScanTopology& found, bool lines_counted) {
  ASSERT_EQ(found.line.size(), truth.theta.size());
  std::map<std::pair<int, int>, int> pulse_of;
  for (std::size_t i = 0; i < truth.theta.size(); ++i) {
    const int line = lines_counted || truth.line[i] < 11 ? truth.line[i] : truth.line[i] - 1;
    ASSERT_EQ(found.line[i], line) << i;
    ASSERT_NEAR(found.index[i], truth.pulse[i] - 150, 4) << i;  // numbered by angle, to a few pulses
    const auto [known, fresh] = pulse_of.try_emplace({found.line[i], found.index[i]}, truth.pulse[i]);
    ASSERT_EQ(known->second, truth.pulse[i]) << "two pulses share a number";
  }
}

TEST(RecoverProfiles, FindsLinesAndPulsesWithTimes) {
  for (const bool falling : {false, true}) {
    const Profiler truth = simulate(falling, 1);
    expect_truth(truth, recover_profiles(truth.theta, truth.times), true);
  }
}

TEST(RecoverProfiles, FindsLinesWithoutTimes) {
  const Profiler truth = simulate(false, 2);
  expect_truth(truth, recover_profiles(truth.theta, {}), false);
}

TEST(RecoverProfiles, TakesDegrees) {
  Profiler truth = simulate(false, 3);
  for (double& angle : truth.theta) angle *= 180.0 / std::numbers::pi;
  expect_truth(truth, recover_profiles(truth.theta, truth.times), true);
}

TEST(RecoverProfiles, SortsByTime) {
  const Profiler truth = simulate(false, 4);
  Profiler shuffled;
  const std::size_t half = truth.theta.size() / 2;
  for (std::size_t i = 0; i < truth.theta.size(); ++i) {
    const std::size_t from = (i + half) % truth.theta.size();
    shuffled.theta.push_back(truth.theta[from]);
    shuffled.times.push_back(truth.times[from]);
    shuffled.line.push_back(truth.line[from]);
    shuffled.pulse.push_back(truth.pulse[from]);
  }
  expect_truth(shuffled, recover_profiles(shuffled.theta, shuffled.times), true);
}

TEST(RecoverProfiles, SaysNothingWhereThereIsNoOrder) {
  RandomStream random(5);
  std::vector<double> noise;
  std::vector<double> swing;
  for (int i = 0; i < 5000; ++i) {
    noise.push_back(random.uniform(-3.0, 3.0));
    swing.push_back(std::abs((i % 200) - 100.0) * 0.01);  // to and fro
  }
  EXPECT_FALSE(recover_profiles(noise, {}).known());
  EXPECT_FALSE(recover_profiles(swing, {}).known());
  EXPECT_FALSE(recover_profiles(std::vector<double>(5000, 1.0), {}).known());
  EXPECT_FALSE(recover_profiles({}, {}).known());
  noise.assign(5000, std::numeric_limits<double>::quiet_NaN());
  EXPECT_FALSE(recover_profiles(noise, {}).known());
}

}  // namespace
}  // namespace limen
