// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <vector>

#include "limen/project/graph/shared_views.h"

namespace limen {

/// A pair of rooms that agrees, from which the project learns.
struct WeighedPair {
  std::size_t number = 0;  ///< among all
  int source = -1;
  int target = -1;
  double weight = 0.0;  ///< each scan counts once, by the mean of its pairs, and a pair is of two scans

  [[nodiscard]] bool is_within(const std::vector<bool>& side) const {
    return side[static_cast<std::size_t>(source)] == side[static_cast<std::size_t>(target)];
  }
};
std::vector<WeighedPair> weighed_pairs(int nodes, const std::vector<PlacedPair>& pairs);

/// Shares of N cases, as pairs of a project show them that agree: one sensor took most of its scans, and on
/// one day. The shares have a Dirichlet distribution beforehand; expectation maximisation.
template <std::size_t N>
class LearnedShares {
 public:
  using Shares = std::array<double, N>;

  /// `strength`: how well the shares are known beforehand, in scans. `logs`: of what a pair shows in each
  /// case the logarithm of the likelihood.
  LearnedShares(int nodes, const std::vector<PlacedPair>& pairs, const Shares& beforehand, double strength,
                const std::function<Shares(const PairEvidence&)>& logs)
      : beforehand_(beforehand), strength_(strength) {
    std::vector<Shares> seen;
    for (const WeighedPair& pair : weighed_pairs(nodes, pairs)) {
      pairs_.push_back({pair, {}});
      seen.push_back(likelihoods(logs(pairs[pair.number].evidence)));
    }
    Shares shares = beforehand;
    for (int round = 0; round < kRounds; ++round) {
      for (std::size_t k = 0; k < pairs_.size(); ++k) pairs_[k].shares = shown_by(seen[k], shares);
      shares = mean([](const WeighedPair&) { return true; });
    }
  }

  /// By all pairs but those that cross the border of `side`: they are to be judged.
  [[nodiscard]] Shares without(const std::vector<bool>& side) const {
    return mean([&](const WeighedPair& pair) { return pair.is_within(side); });
  }

 private:
  static constexpr int kRounds = 30;

  struct Pair {
    WeighedPair pair;
    Shares shares{};  ///< what it shows, given the shares of all pairs
  };

  static Shares likelihoods(Shares logs) {
    const double most = *std::max_element(logs.begin(), logs.end());
    for (double& log : logs) log = std::exp(std::max(-300.0, log - most));
    return logs;
  }
  static Shares shown_by(const Shares& likelihoods, const Shares& shares) {
    Shares shown{};
    double sum = 0.0;
    for (std::size_t j = 0; j < N; ++j) sum += shown[j] = shares[j] * likelihoods[j];
    for (double& share : shown) share /= sum;
    return shown;
  }
  template <typename Counts>
  [[nodiscard]] Shares mean(const Counts& counts) const {
    Shares sum = beforehand_;
    for (double& share : sum) share *= strength_;
    double weight = strength_;
    for (const auto& [pair, shown] : pairs_) {
      if (!counts(pair)) continue;
      for (std::size_t j = 0; j < N; ++j) sum[j] += pair.weight * shown[j];
      weight += pair.weight;
    }
    for (double& share : sum) share /= weight;
    return sum;
  }

  Shares beforehand_;
  double strength_;
  std::vector<Pair> pairs_;
};

}  // namespace limen
