// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/learned_shares.h"

#include <algorithm>

namespace limen {
namespace {

constexpr double kLeastSharedM2 = 1e-3;

}  // namespace

RoomPairs::RoomPairs(const Viewpoints& viewpoints, int nodes, const std::vector<PlacedPair>& pairs) {
  std::vector<bool> paired(static_cast<std::size_t>(nodes), false);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const PlacedPair& pair = pairs[k];
    if (pair.link < 0 || !pair.evidence.asks_things() || viewpoints.is_same(pair.source, pair.target))
      continue;
    numbers_.push_back(k);
    ends_.push_back({static_cast<std::size_t>(pair.source), static_cast<std::size_t>(pair.target),
                     std::max(kLeastSharedM2, pair.shared_m2)});
    paired[ends_.back().source] = paired[ends_.back().target] = true;
  }
  weight_ = viewpoints.weights(paired);
}

std::vector<double> RoomPairs::weights_without(const std::vector<bool>& side) const {
  std::vector<double> all_m2(weight_.size(), 0.0);
  for (const Ends& ends : ends_) {
    if (side[ends.source] != side[ends.target]) continue;
    all_m2[ends.source] += ends.shared_m2;
    all_m2[ends.target] += ends.shared_m2;
  }
  std::vector<double> weights;
  weights.reserve(ends_.size());
  for (const Ends& ends : ends_) {
    const bool within = side[ends.source] == side[ends.target];
    const auto part = [&](std::size_t node) { return 0.5 * weight_[node] * ends.shared_m2 / all_m2[node]; };
    weights.push_back(within ? part(ends.source) + part(ends.target) : 0.0);
  }
  return weights;
}

}  // namespace limen
