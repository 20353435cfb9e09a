// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/twin_rate.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "limen/base/disjoint_sets.h"

namespace limen {
namespace {

constexpr double kLeastFactor = 1.0 / 15.0;
constexpr double kMostOfPair = 50.0;
constexpr int kOtherwiseShares = 120;
constexpr int kAlikeShares = 16;  // of the rest

double likelihood(double nats_against) {
  return std::exp(-std::clamp(nats_against, -kMostOfPair, kMostOfPair));
}

/// By how much more probable a twin of either kind makes what was seen than one room does.
double likelihood_of_twin(const TwinEvidence& evidence) {
  const double alike = evidence.alike / (evidence.alike + evidence.otherwise);
  return (1.0 - alike) * likelihood(evidence.otherwise_nats) + alike * likelihood(evidence.alike_nats);
}

/// A share that is known as Beta(a, b), within bounds.
struct BetaCell {
  double mean = 0.0;
  double believed = 0.0;  ///< but for a factor that all have in common
};

/// Of x^(a - 1) (1 - x)^(b - 1) the factor that has the pole on this side is integrated in closed form, and
/// so is its mean; the other is nearly constant there.
BetaCell beta_cell(double low, double high, double a, double b) {
  const double middle = 0.5 * (low + high);
  if (middle > 0.5) {
    const BetaCell mirrored = beta_cell(1.0 - high, 1.0 - low, b, a);
    return {1.0 - mirrored.mean, mirrored.believed};
  }
  const double pole = (std::pow(high, a) - std::pow(low, a)) / a;
  const double first = (std::pow(high, a + 1.0) - std::pow(low, a + 1.0)) / (a + 1.0);
  return {first / pole, pole * std::pow(1.0 - middle, b - 1.0)};
}

std::vector<BetaCell> beta_cells(int count, double a, double b) {
  std::vector<BetaCell> cells;
  for (int i = 0; i < count; ++i)
    cells.push_back(beta_cell(static_cast<double>(i) / count, static_cast<double>(i + 1) / count, a, b));
  return cells;
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

double TwinRate::Lesson::log_likelihood(const Shares& shares) const {
  const double rest = 1.0 - shares.otherwise;
  return std::log(shares.otherwise * otherwise + rest * (1.0 - shares.alike_of_rest * (1.0 - alike)));
}

TwinRate::TwinRate(int nodes, const std::vector<TwinWitness>& witnesses) {
  // Of a Dirichlet distribution the share of one kind and that of another in the rest are independent, each
  // a beta distribution.
  const TwinEvidence alone;
  const double one_room = 1.0 - alone.otherwise - alone.alike;
  const std::vector<BetaCell> alike_cells = beta_cells(kAlikeShares, alone.alike, one_room);
  for (const BetaCell& otherwise : beta_cells(kOtherwiseShares, alone.otherwise, 1.0 - alone.otherwise)) {
    for (const BetaCell& alike : alike_cells)
      shares_.push_back(
          {otherwise.mean, alike.mean, std::log(otherwise.believed) + std::log(alike.believed)});
  }
  mean_before_ = mean(shares_);
  for (const std::size_t k : most_telling(nodes, witnesses)) {
    const TwinEvidence& said = witnesses[k].evidence;
    lessons_.push_back({witnesses[k].source, witnesses[k].target, likelihood(said.otherwise_nats),
                        likelihood(said.alike_nats)});
    for (Shares& shares : shares_) shares.log_believed += lessons_.back().log_likelihood(shares);
  }
}

TwinRate::Shares TwinRate::mean(const std::vector<Shares>& all) {
  double most = all.front().log_believed;
  for (const Shares& shares : all) most = std::max(most, shares.log_believed);
  Shares sum;
  double weight = 0.0;
  for (const Shares& shares : all) {
    const double believed = std::exp(shares.log_believed - most);
    weight += believed;
    sum.otherwise += believed * shares.otherwise;
    sum.alike_of_rest += believed * shares.alike_of_rest;
  }
  return {sum.otherwise / weight, sum.alike_of_rest / weight, 0.0};
}

TwinFactors TwinRate::factors(const std::vector<bool>& side) const {
  std::vector<Shares> all = shares_;
  for (const Lesson& lesson : lessons_) {
    if (side[static_cast<std::size_t>(lesson.source)] == side[static_cast<std::size_t>(lesson.target)])
      continue;
    for (Shares& shares : all) shares.log_believed -= lesson.log_likelihood(shares);
  }
  const Shares now = mean(all);
  return {std::max(kLeastFactor, now.otherwise / mean_before_.otherwise),
          std::max(kLeastFactor, now.alike_of_rest / mean_before_.alike_of_rest)};
}

}  // namespace limen
