// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/as_drawn.h"

#include <vector>

#include <gtest/gtest.h>

#include "limen/register/judge/evidence_table.h"

namespace limen {
namespace {

/// Scans in a row, each paired with the next; the walls of each pair say so much for a building that is
/// exactly as drawn.
std::vector<PlacedPair> drawn_row(int scans, double nats) {
  std::vector<PlacedPair> pairs;
  for (int n = 1; n < scans; ++n) {
    PairEvidence evidence;
    evidence.asks_look_alike = true;
    evidence.look_alikes.built.as_drawn.fill(nats);
    pairs.push_back({n, n - 1, 20.0, evidence, n});
  }
  return pairs;
}

double without_last(int scans, const std::vector<PlacedPair>& pairs) {
  std::vector<bool> last(static_cast<std::size_t>(scans), false);
  last.back() = true;
  return AsDrawn(Viewpoints(scans), scans, pairs).without(last, bends_beforehand());
}

TEST(AsDrawn, WithoutWallsIsWhatIsBelieved) {
  EXPECT_NEAR(without_last(2, {}), evidence_table::kAsDrawn, 1e-12);
  EXPECT_NEAR(without_last(10, drawn_row(10, 0.0)), evidence_table::kAsDrawn, 1e-12);
}

TEST(AsDrawn, IsLearnedFromAllPairsButThoseThatAreJudged) {
  EXPECT_NEAR(without_last(2, drawn_row(2, 9.0)), evidence_table::kAsDrawn, 1e-12);
  EXPECT_GT(without_last(8, drawn_row(8, 3.0)), 0.99);
  EXPECT_LT(without_last(8, drawn_row(8, -3.0)), 1e-4);
  EXPECT_GT(without_last(8, drawn_row(8, 1.0)), without_last(5, drawn_row(5, 1.0)));
}

TEST(AsDrawn, AScanCountsOnceHoweverManyPairsItHas) {
  std::vector<PlacedPair> pairs = drawn_row(6, 0.5);
  const double once = without_last(6, pairs);
  for (int k = 0; k < 20; ++k) pairs.push_back(pairs[1]);
  EXPECT_NEAR(without_last(6, pairs), once, 0.3 * once);
}

}  // namespace
}  // namespace limen
