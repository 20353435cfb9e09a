// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/as_drawn.h"

#include <algorithm>

#include "limen/register/judge/as_built.h"

namespace limen {

AsDrawn::AsDrawn(const Viewpoints& viewpoints, int nodes, const std::vector<PlacedPair>& pairs)
    : pairs_(viewpoints, nodes, pairs) {
  for (const std::size_t k : pairs_.numbers()) walls_.push_back(pairs[k].evidence.look_alikes.built);
}

double AsDrawn::without(const std::vector<bool>& side, const BendBelief& bends) const {
  const std::vector<double> weights = pairs_.weights_without(side);
  double nats = 0.0;
  for (std::size_t k = 0; k < walls_.size(); ++k) {
    if (weights[k] > 0.0)
      nats += weights[k] * std::clamp(as_drawn_nats(walls_[k], bends), -kMostPairNats, kMostPairNats);
  }
  return probability_as_drawn(nats);
}

}  // namespace limen
