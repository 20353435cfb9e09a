// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/twin_rate.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "limen/base/disjoint_sets.h"

namespace limen {
namespace {

constexpr double kLeastFactor = 1.0 / 15.0;

/// By how much more probable a twin of either kind makes what was seen than one room does.
double likelihood_of_twin(const TwinEvidence& evidence) {
  const double alike = evidence.alike / (evidence.alike + evidence.otherwise);
  return (1.0 - alike) * std::exp(-evidence.otherwise_nats) + alike * std::exp(-evidence.alike_nats);
}

/// The share of Beta(mean, 1 - mean) between two rates: of its two factors that with a pole on this side is
/// integrated in closed form.
double believed_between(double low, double high, double mean) {
  const double middle = 0.5 * (low + high);
  if (middle < 0.5)
    return (std::pow(high, mean) - std::pow(low, mean)) / mean * std::pow(1.0 - middle, -mean);
  const double rest = 1.0 - mean;
  return (std::pow(1.0 - low, rest) - std::pow(1.0 - high, rest)) / rest * std::pow(middle, -rest);
}

/// Numbers of the witnesses that count: the most telling of each loop.
std::vector<std::size_t> most_telling(int nodes, const std::vector<TwinWitness>& witnesses) {
  std::vector<std::size_t> order(witnesses.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto nats = [&](std::size_t k) {
    return std::abs(std::log(likelihood_of_twin(witnesses[k].evidence)));
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return nats(a) > nats(b); });
  DisjointSets sets(static_cast<std::size_t>(nodes));
  std::vector<std::size_t> chosen;
  for (const std::size_t k : order) {
    if (sets.join(static_cast<std::size_t>(witnesses[k].source),
                  static_cast<std::size_t>(witnesses[k].target)))
      chosen.push_back(k);
  }
  return chosen;
}

}  // namespace

TwinRate::TwinRate(int nodes, const std::vector<TwinWitness>& witnesses) {
  const TwinEvidence alone;
  const double mean = alone.otherwise + alone.alike;
  for (std::size_t i = 0; i < kRates; ++i) {
    const auto low = static_cast<double>(i) / static_cast<double>(kRates);
    const auto high = static_cast<double>(i + 1) / static_cast<double>(kRates);
    logs_[i] = std::log(believed_between(low, high, mean));
  }
  mean_before_ = mean_rate(logs_);
  for (const std::size_t k : most_telling(nodes, witnesses)) {
    Lesson lesson{witnesses[k].source, witnesses[k].target, {}};
    const double twin = likelihood_of_twin(witnesses[k].evidence);
    for (std::size_t i = 0; i < kRates; ++i) {
      lesson.logs[i] = std::log(rate(i) * twin + 1.0 - rate(i));
      logs_[i] += lesson.logs[i];
    }
    lessons_.push_back(lesson);
  }
}

double TwinRate::mean_rate(const Grid& logs) {
  const double most = *std::max_element(logs.begin(), logs.end());
  double sum = 0.0;
  double weighed = 0.0;
  for (std::size_t i = 0; i < kRates; ++i) {
    const double believed = std::exp(logs[i] - most);
    sum += believed;
    weighed += believed * rate(i);
  }
  return weighed / sum;
}

double TwinRate::factor(const std::vector<bool>& side) const {
  Grid logs = logs_;
  for (const Lesson& lesson : lessons_) {
    if (side[static_cast<std::size_t>(lesson.source)] == side[static_cast<std::size_t>(lesson.target)])
      continue;
    for (std::size_t i = 0; i < kRates; ++i) logs[i] -= lesson.logs[i];
  }
  return std::max(kLeastFactor, mean_rate(logs) / mean_before_);
}

}  // namespace limen
