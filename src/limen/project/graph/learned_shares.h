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
#include "limen/project/graph/viewpoints.h"

namespace limen {

/// Pairs of rooms that agree, from which a project learns.
class RoomPairs {
 public:
  RoomPairs(const Viewpoints& viewpoints, int nodes, const std::vector<PlacedPair>& pairs);

  /// Their numbers among all pairs.
  [[nodiscard]] const std::vector<std::size_t>& numbers() const { return numbers_; }
  /// How much each counts if those that cross the border of `side` do not, for they are to be judged: a place
  /// that scans were taken from counts once, by the mean of its pairs weighed by the surface they share, and
  /// a pair is of two.
  [[nodiscard]] std::vector<double> weights_without(const std::vector<bool>& side) const;

 private:
  struct Ends {
    std::size_t source = 0;
    std::size_t target = 0;
    double shared_m2 = 0.0;
  };
  std::vector<double> weight_;  ///< of each node
  std::vector<std::size_t> numbers_;
  std::vector<Ends> ends_;
};

/// Shares of N cases, as pairs of a project show them that agree: one sensor took most of its scans, and on
/// one day. The shares have a Dirichlet distribution beforehand; expectation maximisation.
template <std::size_t N>
class LearnedShares {
 public:
  using Shares = std::array<double, N>;

  /// `strength`: how well the shares are known beforehand, in scans. `logs`: of what a pair shows in each
  /// case the logarithm of the likelihood.
  LearnedShares(const Viewpoints& viewpoints, int nodes, const std::vector<PlacedPair>& pairs,
                const Shares& beforehand, double strength,
                const std::function<Shares(const PairEvidence&)>& logs)
      : beforehand_(beforehand), strength_(strength), pairs_(viewpoints, nodes, pairs) {
    for (const std::size_t k : pairs_.numbers()) seen_.push_back(likelihoods(logs(pairs[k].evidence)));
    by_all_ = settled(std::vector<bool>(static_cast<std::size_t>(nodes), false), beforehand);
  }

  /// By all pairs but those that cross the border of `side`.
  [[nodiscard]] Shares without(const std::vector<bool>& side) const { return settled(side, by_all_); }

 private:
  static constexpr int kRounds = 30;
  static constexpr double kSettled = 1e-5;

  /// There is one solution, wherever the search starts: from near by it takes few rounds.
  [[nodiscard]] Shares settled(const std::vector<bool>& side, Shares shares) const {
    const std::vector<double> weights = pairs_.weights_without(side);
    for (int round = 0; round < kRounds; ++round) {
      const Shares before = shares;
      shares = learned(weights, before);
      double moved = 0.0;
      for (std::size_t j = 0; j < N; ++j) moved = std::max(moved, std::abs(shares[j] - before[j]));
      if (moved < kSettled) break;
    }
    return shares;
  }

  static Shares likelihoods(Shares logs) {
    const double most = *std::max_element(logs.begin(), logs.end());
    for (double& log : logs) log = std::exp(std::max(-300.0, log - most));
    return logs;
  }
  /// What the pairs show, given these shares, and what was believed beforehand.
  [[nodiscard]] Shares learned(const std::vector<double>& weights, const Shares& shares) const {
    Shares sum = beforehand_;
    for (double& share : sum) share *= strength_;
    double weight = strength_;
    for (std::size_t k = 0; k < seen_.size(); ++k) {
      if (weights[k] == 0.0) continue;
      double all = 0.0;
      for (std::size_t j = 0; j < N; ++j) all += shares[j] * seen_[k][j];
      for (std::size_t j = 0; j < N; ++j) sum[j] += weights[k] * shares[j] * seen_[k][j] / all;
      weight += weights[k];
    }
    for (double& share : sum) share /= weight;
    return sum;
  }

  Shares beforehand_;
  double strength_;
  RoomPairs pairs_;
  std::vector<Shares> seen_;  ///< likelihoods by each pair
  Shares by_all_{};
};

}  // namespace limen
