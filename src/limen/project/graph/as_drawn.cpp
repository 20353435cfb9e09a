// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/as_drawn.h"

#include <algorithm>
#include <cmath>

#include "limen/register/judge/evidence_table.h"

namespace limen {

AsDrawn::AsDrawn(int nodes, const std::vector<PlacedPair>& pairs) {
  for (const WeighedPair& pair : weighed_pairs(nodes, pairs))
    walls_.push_back({pair, pairs[pair.number].evidence.twins.built});
}

double AsDrawn::without(const std::vector<bool>& side, const BendBelief& bends) const {
  double log_odds = std::log(evidence_table::kAsDrawn / (1.0 - evidence_table::kAsDrawn));
  for (const Walls& walls : walls_) {
    if (walls.pair.is_within(side))
      log_odds +=
          walls.pair.weight * std::clamp(as_drawn_nats(walls.built, bends), -kMostPairNats, kMostPairNats);
  }
  return 1.0 / (1.0 + std::exp(-log_odds));
}

}  // namespace limen
