// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/spanning_trees.h"

#include <cmath>
#include <initializer_list>
#include <utility>

#include <gtest/gtest.h>

namespace limen {
namespace {

SpanningTrees joined(int nodes, std::initializer_list<std::pair<int, int>> edges) {
  SpanningTrees trees(nodes);
  for (const auto& [a, b] : edges) trees.connect(a, b);
  return trees;
}

SpanningTrees all_joined(int nodes) {
  SpanningTrees trees(nodes);
  for (int a = 0; a < nodes; ++a) {
    for (int b = 0; b < a; ++b) trees.connect(a, b);
  }
  return trees;
}

/// Of a tree every edge cuts one side off, and nothing else does.
TEST(SpanningTrees, OfAChainTheEndsHangByOneEdge) {
  const SpanningTrees chain = joined(4, {{0, 1}, {1, 2}, {2, 3}});
  EXPECT_NEAR(chain.share_of_fewest_edges({false, false, false, true}), 1.0, 1e-12);
  EXPECT_NEAR(chain.share_of_fewest_edges({false, false, true, true}), 1.0, 1e-12);
  EXPECT_NEAR(chain.share_of_fewest_edges({false, false, true, false}), 1.0, 1e-12);  // joined to either end
  EXPECT_EQ(chain.share_of_fewest_edges({true, false, false, true}), 0.0);
}

/// Of nodes of which each joins every other, by Cayley's formula.
TEST(SpanningTrees, OfACompleteGraphAsCayleyCounts) {
  const SpanningTrees trees = all_joined(6);
  EXPECT_NEAR(trees.share_of_fewest_edges({false, false, false, false, false, true}), std::pow(5.0 / 6.0, 4),
              1e-12);
  // m^(m-1) (n-m)^(n-m-1) / n^(n-2)
  EXPECT_NEAR(trees.share_of_fewest_edges({true, true, true, false, false, false}), 81.0 / 1296.0, 1e-12);
}

/// Of a triangle with edges of weights 1, 1/2 and 1/2 the trees weigh 1/2, 1/2 and 1/4.
TEST(SpanningTrees, CountByTheWeightsOfTheirEdges) {
  SpanningTrees trees(3);
  trees.connect(0, 1);
  trees.connect(1, 2, 0.5);
  trees.connect(2, 0, 0.5);
  EXPECT_NEAR(trees.share_of_fewest_edges({false, false, true}), 0.8, 1e-12);
  RandomStream random(3);
  constexpr int kTrees = 4000;
  int single = 0;
  for (int k = 0; k < kTrees; ++k) {
    const std::vector<int> parent = trees.random_tree({0}, random);
    if (parent[1] == 0 || parent[2] == 1) ++single;
  }
  // That of weights 1/2 and 1/2 joins 1 to 2 and 2 to 0.
  EXPECT_NEAR(single, kTrees * 0.8, 4.0 * std::sqrt(kTrees * 0.8 * 0.2));
}

TEST(SpanningTrees, OtherComponentsChangeNothing) {
  const SpanningTrees trees = joined(5, {{0, 1}, {1, 2}, {0, 2}, {3, 4}});
  EXPECT_NEAR(trees.share_of_fewest_edges({false, false, true, false, false}), 2.0 / 3.0, 1e-12);
  EXPECT_NEAR(trees.share_of_fewest_edges({false, false, false, false, true}), 1.0, 1e-12);
}

/// Random trees cut a side off as often as Kirchhoff's theorem says; four standard errors are allowed.
TEST(SpanningTrees, RandomTreesAgreeWithTheShares) {
  const SpanningTrees trees = joined(6, {{0, 1}, {1, 2}, {2, 0}, {2, 3}, {3, 4}, {4, 2}});
  RandomStream random(5);
  constexpr int kTrees = 4000;
  int ends = 0;
  int alone = 0;
  for (int k = 0; k < kTrees; ++k) {
    const std::vector<int> parent = trees.random_tree({0}, random);
    EXPECT_EQ(parent[0], -1);
    EXPECT_EQ(parent[5], -1);  // is not reached
    if (parent[4] == 3) ++ends;
    if (parent[1] != 2 && parent[2] != 1) ++alone;
  }
  const auto expect = [&](int count, double share) {
    EXPECT_NEAR(count, kTrees * share, 4.0 * std::sqrt(kTrees * share * (1.0 - share)));
  };
  expect(ends, 1.0 / 3.0);
  expect(alone, 1.0 / 3.0);
}

}  // namespace
}  // namespace limen
