// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/as_drawn.h"

#include <algorithm>

#include "limen/register/judge/as_built.h"

namespace limen {

AsDrawn::AsDrawn(int nodes, const std::vector<PlacedPair>& pairs) {
  for (const WeighedPair& pair : weighed_pairs(nodes, pairs))
    walls_.push_back({pair, pairs[pair.number].evidence.look_alikes.built});
}

double AsDrawn::without(const std::vector<bool>& side, const BendBelief& bends) const {
  double nats = 0.0;
  for (const Walls& walls : walls_) {
    if (walls.pair.is_within(side))
      nats +=
          walls.pair.weight * std::clamp(as_drawn_nats(walls.built, bends), -kMostPairNats, kMostPairNats);
  }
  return probability_as_drawn(nats);
}

}  // namespace limen
