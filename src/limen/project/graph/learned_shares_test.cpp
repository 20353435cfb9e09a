// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/learned_shares.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace limen {
namespace {

using TwoShares = LearnedShares<2>;

/// A pair of rooms; `nats`: what it says for the first case against the second.
PlacedPair room_pair(int source, int target, double nats, double shared_m2 = 20.0) {
  PlacedPair made{source, target, shared_m2, {}, 0};
  made.evidence.asks_look_alike = true;
  made.evidence.chance_nats = nats;
  return made;
}

double first_share(int nodes, const std::vector<PlacedPair>& pairs, const std::vector<bool>& side) {
  const TwoShares shares(Viewpoints(nodes), nodes, pairs, {0.5, 0.5}, 0.2, [](const PairEvidence& evidence) {
    return TwoShares::Shares{evidence.chance_nats, 0.0};
  });
  return shares.without(side)[0];
}

/// Two houses, each with scans of one place; what would join them says the opposite.
TEST(LearnedShares, WhatIsJudgedIsNotLearnedFrom) {
  const std::vector<bool> second_house{false, false, true, true};
  const std::vector<PlacedPair> within{room_pair(1, 0, 9.0), room_pair(3, 2, 9.0)};
  std::vector<PlacedPair> all = within;
  for (const int source : {2, 3}) {
    for (const int target : {0, 1}) all.push_back(room_pair(source, target, -9.0));
  }
  EXPECT_NEAR(first_share(4, all, second_house), first_share(4, within, second_house), 1e-4);
  EXPECT_GT(first_share(4, within, second_house), 0.9);
  EXPECT_LT(first_share(4, all, {false, false, false, true}), 0.5);
}

/// A scan counts once; its pairs that share much surface say more of it than those that share little.
TEST(LearnedShares, PairsCountByTheSurfaceTheyShare) {
  const std::vector<bool> nothing(4, false);
  const auto with_narrow = [&](double narrow_m2) {
    return first_share(4, {room_pair(1, 0, 9.0, 40.0), room_pair(2, 0, -9.0, narrow_m2)}, nothing);
  };
  EXPECT_GT(with_narrow(2.0), with_narrow(40.0));
  EXPECT_NEAR(first_share(4, {room_pair(1, 0, 9.0, 1.0)}, nothing),
              first_share(4, {room_pair(1, 0, 9.0, 50.0)}, nothing), 1e-12);
}

}  // namespace
}  // namespace limen
