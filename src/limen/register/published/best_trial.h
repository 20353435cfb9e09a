// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "limen/base/parallel.h"
#include "limen/base/random.h"

namespace limen {

/// What random trials came to.
struct BestTrial {
  std::size_t trial = 0;  ///< RandomStream(seed, trial) draws the hypothesis again
  double cost = 0.0;
  std::size_t judged = 0;  ///< trials whose sample gave a hypothesis
};

/// The random search of 2022, 3.2, and 2023, III-B and IV-C: `draw(RandomStream&)` gives a hypothesis or
/// nothing, `cost(hypothesis)` is minimised over all trials; the first of equals is taken. The same for any
/// number of threads. None where no trial gave a hypothesis.
template <typename Draw, typename Cost>
std::optional<BestTrial> best_trial(std::size_t trials, std::uint64_t seed, const Draw& draw,
                                    const Cost& cost) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  std::vector<double> costs(trials, kNone);
  parallel_for(trials, 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t trial = begin; trial < end; ++trial) {
      RandomStream random(seed, trial);
      if (const auto hypothesis = draw(random)) costs[trial] = cost(*hypothesis);
    }
  });
  const auto lowest = std::min_element(costs.begin(), costs.end());
  if (lowest == costs.end() || *lowest == kNone) return std::nullopt;
  BestTrial best;
  best.trial = static_cast<std::size_t>(lowest - costs.begin());
  best.cost = *lowest;
  best.judged =
      static_cast<std::size_t>(std::count_if(costs.begin(), costs.end(), [](double c) { return c < kNone; }));
  return best;
}

}  // namespace limen
