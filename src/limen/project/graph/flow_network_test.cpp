// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/flow_network.h"

#include <random>

#include <gtest/gtest.h>

namespace limen {
namespace {

constexpr int kStations = 12;

FlowNetwork random_network(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> node(0, kStations - 1);
  std::uniform_int_distribution<int> room(0, 9);
  FlowNetwork network(kStations);
  for (int k = 0; k < 30; ++k) {
    const int a = node(random);
    const int b = node(random);
    if (a != b) network.connect(a, b, room(random), room(random));
  }
  return network;
}

std::vector<bool> only(int node) {
  std::vector<bool> nodes(kStations, false);
  nodes[static_cast<std::size_t>(node)] = true;
  return nodes;
}

TEST(FlowNetwork, TheSmallestOfTwoCutsIsFound) {
  FlowNetwork chain(4);
  chain.connect(0, 1, 5, 5);
  chain.connect(1, 2, 2, 2);
  chain.connect(2, 3, 4, 4);
  const std::vector<bool> end{false, false, false, true};
  EXPECT_EQ(chain.smallest_cut({0}, end, 100), (std::vector<bool>{true, true, false, false}));
  EXPECT_EQ(chain.smallest_cut({0}, end, 2), std::nullopt);
}

TEST(FlowNetwork, ACutDoesNotDependOnThoseSoughtBefore) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    FlowNetwork used = random_network(seed);
    for (int start = 1; start < kStations; ++start) {
      for (const int enough : {6, 1000}) {
        FlowNetwork fresh = random_network(seed);
        EXPECT_EQ(used.smallest_cut({start}, only(0), enough), fresh.smallest_cut({start}, only(0), enough))
            << "seed " << seed << ", from " << start;
      }
    }
  }
}

}  // namespace
}  // namespace limen
