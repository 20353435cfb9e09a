// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "limen/model/twin_evidence.h"

namespace limen {

/// What the things of two scans whose walls fit say of a twin.
struct TwinWitness {
  int source = -1;
  int target = -1;
  TwinEvidence evidence;
};

/// How many of the pairs whose walls fit are twins is a property of a building: a hotel has many, a villa
/// none. It is known as a beta distribution with the mean that one pair alone is given and the strength of
/// one observation, and learned from all pairs whose things say something. What says nothing teaches nothing.
/// Of pairs that lie in a loop only the most telling ones count, so that one room seen from many places is
/// not many.
class TwinRate {
 public:
  TwinRate(int nodes, const std::vector<TwinWitness>& witnesses);

  /// By what to multiply the probability of a twin that is believed beforehand of one pair alone, for links
  /// from the nodes on one `side` to those on the other; what pairs say that lead across teaches them
  /// nothing. Never less than a fifteenth: no number of other rooms makes two bare ones the same.
  [[nodiscard]] double factor(const std::vector<bool>& side) const;

 private:
  static constexpr std::size_t kRates = 200;
  using Grid = std::array<double, kRates>;
  static double rate(std::size_t i) { return (static_cast<double>(i) + 0.5) / static_cast<double>(kRates); }
  static double mean_rate(const Grid& logs);

  struct Lesson {
    int source = -1;
    int target = -1;
    Grid logs{};
  };

  Grid logs_{};  ///< of what is believed of each rate
  double mean_before_ = 0.0;
  std::vector<Lesson> lessons_;
};

}  // namespace limen
