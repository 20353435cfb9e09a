// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/table/profile_topology.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>

#include "limen/base/ranked.h"

namespace limen {
namespace {

/// A jump back by more steps than this begins a new profile; less is jitter of the encoder.
constexpr double kJumpSteps = 20.0;
/// Shorter profiles (points, median) are no profiles.
constexpr std::size_t kShortestProfile = 20;
/// Angles that grow in a smaller share of steps than this are in no order.
constexpr double kSteadyShare = 0.9;

double median_or_zero(std::vector<double> values) {
  return values.empty() ? 0.0 : median(values);
}

/// The echoes in the order of measurement.
struct Echoes {
  std::vector<std::uint32_t> order;  ///< empty: as they are
  std::vector<double> theta;         ///< growing within a profile
  std::vector<double> times;         ///< or empty

  [[nodiscard]] std::size_t size() const { return theta.size(); }
  [[nodiscard]] double turn(std::size_t i) const { return theta[i] - theta[i - 1]; }
  [[nodiscard]] double wait(std::size_t i) const { return times.empty() ? 0.0 : times[i] - times[i - 1]; }
  [[nodiscard]] bool same_pulse(std::size_t i) const {
    return times.empty() ? turn(i) == 0.0 : wait(i) == 0.0;
  }
};

Echoes in_order(const std::vector<double>& theta, const std::vector<double>& times) {
  if (times.empty() || std::is_sorted(times.begin(), times.end())) return {{}, theta, times};
  Echoes echoes;
  echoes.order.resize(theta.size());
  std::iota(echoes.order.begin(), echoes.order.end(), 0U);
  std::stable_sort(echoes.order.begin(), echoes.order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return times[a] < times[b]; });
  for (const std::uint32_t i : echoes.order) {
    echoes.theta.push_back(theta[i]);
    echoes.times.push_back(times[i]);
  }
  return echoes;
}

/// How the mirror turns.
struct Rhythm {
  double step = 0.0;    ///< angle between pulses; 0: no steady turning
  double rate = 0.0;    ///< angle per second; 0: unknown
  double period = 0.0;  ///< seconds from profile to profile; 0: unknown
};

/// Turns the angles round where they fall; false where they do neither.
bool make_growing(Echoes& echoes) {
  std::size_t growing = 0;
  std::size_t falling = 0;
  for (std::size_t i = 1; i < echoes.size(); ++i) {
    growing += echoes.turn(i) > 0.0 ? 1U : 0U;
    falling += echoes.turn(i) < 0.0 ? 1U : 0U;
  }
  if (falling > growing) {
    for (double& angle : echoes.theta) angle = -angle;
  }
  const auto most = static_cast<double>(std::max(growing, falling));
  return most > kSteadyShare * static_cast<double>(growing + falling);
}

Rhythm rhythm_of(const Echoes& echoes) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < echoes.size(); ++i) {
    if (echoes.turn(i) > 0.0) steps.push_back(echoes.turn(i));
  }
  const double typical = median_or_zero(std::move(steps));
  Rhythm rhythm;
  double turned = 0.0;
  double waited = 0.0;
  double pulses = 0.0;
  for (std::size_t i = 1; i < echoes.size(); ++i) {
    if (echoes.turn(i) < 0.5 * typical || echoes.turn(i) > 1.5 * typical) continue;
    turned += echoes.turn(i);
    waited += echoes.wait(i);
    pulses += 1.0;
  }
  if (typical <= 0.0 || pulses == 0.0) return rhythm;
  rhythm.step = turned / pulses;
  if (waited > 0.0) rhythm.rate = turned / waited;
  return rhythm;
}

bool jumps_back(const Echoes& echoes, std::size_t i, const Rhythm& rhythm) {
  return echoes.turn(i) < -kJumpSteps * rhythm.step;
}

/// Median time from jump to jump, corrected for the angle at which each profile happens to begin.
double period_of(const Echoes& echoes, const Rhythm& rhythm) {
  if (rhythm.rate == 0.0) return 0.0;
  std::vector<double> periods;
  std::size_t last = 0;
  for (std::size_t i = 1; i < echoes.size(); ++i) {
    if (!jumps_back(echoes, i, rhythm)) continue;
    if (last > 0) {
      const double late = (echoes.theta[i] - echoes.theta[last]) / rhythm.rate;
      periods.push_back(echoes.times[i] - echoes.times[last] - late);
    }
    last = i;
  }
  return periods.size() < 3 ? 0.0 : median_or_zero(std::move(periods));
}

/// Profiles that begin between echo i - 1 and echo i.
std::int32_t profiles_between(const Echoes& echoes, std::size_t i, const Rhythm& rhythm) {
  const std::int32_t seen = jumps_back(echoes, i, rhythm) ? 1 : 0;
  if (rhythm.period <= 0.0 || echoes.wait(i) < 0.5 * rhythm.period) return seen;
  const double by_time = std::round((echoes.wait(i) - echoes.turn(i) / rhythm.rate) / rhythm.period);
  return std::max(seen, static_cast<std::int32_t>(std::clamp(by_time, 0.0, 1.0e6)));
}

ScanTopology number_pulses(const Echoes& echoes, const Rhythm& rhythm) {
  const double first = *std::min_element(echoes.theta.begin(), echoes.theta.end());
  ScanTopology topology;
  topology.line.resize(echoes.size());
  topology.index.resize(echoes.size());
  std::int64_t line = 0;
  std::int32_t index = -1;
  for (std::size_t i = 0; i < echoes.size(); ++i) {
    const std::int32_t begun = i == 0 ? 0 : profiles_between(echoes, i, rhythm);
    line = std::min<std::int64_t>(line + begun, INT32_MAX);
    if (begun > 0) index = -1;
    if (i == 0 || begun > 0 || !echoes.same_pulse(i)) {
      const double by_angle = std::round((echoes.theta[i] - first) / rhythm.step);
      // Rounding may give two pulses one number: the later one moves on, and is overtaken at the next gap.
      index = std::max(index + 1, static_cast<std::int32_t>(std::min(by_angle, 1.0e8)));
    }
    const std::size_t at = echoes.order.empty() ? i : echoes.order[i];
    topology.line[at] = static_cast<std::int32_t>(line);
    topology.index[at] = index;
  }
  return topology;
}

/// At least two profiles, and most of a length that is worth the name. Lines follow the order of `echoes`.
bool plausible(const ScanTopology& topology, const Echoes& echoes) {
  std::vector<double> lengths;
  std::int32_t current = -1;
  for (std::size_t i = 0; i < echoes.size(); ++i) {
    const std::int32_t line = topology.line[echoes.order.empty() ? i : echoes.order[i]];
    if (line != current) lengths.push_back(0.0);
    current = line;
    lengths.back() += 1.0;
  }
  return lengths.size() >= 2 && median_or_zero(std::move(lengths)) >= static_cast<double>(kShortestProfile);
}

bool all_finite(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}

}  // namespace

ScanTopology recover_profiles(const std::vector<double>& theta, const std::vector<double>& times) {
  if (theta.size() < 2 * kShortestProfile || !all_finite(theta) || !all_finite(times)) return {};
  Echoes echoes = in_order(theta, times);
  if (!make_growing(echoes)) return {};
  Rhythm rhythm = rhythm_of(echoes);
  if (rhythm.step <= 0.0) return {};
  rhythm.period = period_of(echoes, rhythm);
  ScanTopology topology = number_pulses(echoes, rhythm);
  if (!plausible(topology, echoes)) return {};
  return topology;
}

}  // namespace limen
