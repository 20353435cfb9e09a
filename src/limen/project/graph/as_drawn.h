// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/project/graph/learned_shares.h"

namespace limen {

/// Whether a building is exactly as drawn, by the walls that its pairs show.
class AsDrawn {
 public:
  AsDrawn(const Viewpoints& viewpoints, int nodes, const std::vector<PlacedPair>& pairs);

  /// The probability, by all pairs but those that cross the border of `side`: they are to be judged.
  [[nodiscard]] double without(const std::vector<bool>& side, const BendBelief& bends) const;

 private:
  RoomPairs pairs_;
  std::vector<BuiltEvidence> walls_;  ///< of each
};

}  // namespace limen
