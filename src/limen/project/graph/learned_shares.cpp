// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/learned_shares.h"

namespace limen {

std::vector<WeighedPair> weighed_pairs(int nodes, const std::vector<PlacedPair>& pairs) {
  std::vector<WeighedPair> weighed;
  std::vector<double> count(static_cast<std::size_t>(nodes), 0.0);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const PlacedPair& pair = pairs[k];
    if (pair.link < 0 || !pair.evidence.asks_things()) continue;
    weighed.push_back({k, pair.source, pair.target});
    count[static_cast<std::size_t>(pair.source)] += 1.0;
    count[static_cast<std::size_t>(pair.target)] += 1.0;
  }
  for (WeighedPair& pair : weighed)
    pair.weight = 0.5 / count[static_cast<std::size_t>(pair.source)] +
                  0.5 / count[static_cast<std::size_t>(pair.target)];
  return weighed;
}

}  // namespace limen
