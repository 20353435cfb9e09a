// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/learned_shares.h"

#include <algorithm>

namespace limen {
namespace {

constexpr double kLeastSharedM2 = 1e-3;

}  // namespace

RoomPairs::RoomPairs(int nodes, const std::vector<PlacedPair>& pairs)
    : nodes_(static_cast<std::size_t>(nodes)) {
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const PlacedPair& pair = pairs[k];
    if (pair.link < 0 || !pair.evidence.asks_things()) continue;
    numbers_.push_back(k);
    ends_.push_back({static_cast<std::size_t>(pair.source), static_cast<std::size_t>(pair.target),
                     std::max(kLeastSharedM2, pair.shared_m2)});
  }
}

std::vector<double> RoomPairs::weights_without(const std::vector<bool>& side) const {
  std::vector<double> all_m2(nodes_, 0.0);
  for (const Ends& ends : ends_) {
    if (side[ends.source] != side[ends.target]) continue;
    all_m2[ends.source] += ends.shared_m2;
    all_m2[ends.target] += ends.shared_m2;
  }
  std::vector<double> weights;
  weights.reserve(ends_.size());
  for (const Ends& ends : ends_) {
    const bool within = side[ends.source] == side[ends.target];
    const double half_m2 = 0.5 * ends.shared_m2;
    weights.push_back(within ? half_m2 / all_m2[ends.source] + half_m2 / all_m2[ends.target] : 0.0);
  }
  return weights;
}

}  // namespace limen
