// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/look_alike_rate.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

namespace limen {
namespace {

PairEvidence evidence(double against_look_alike) {
  PairEvidence made;
  made.chance_nats = 9.0;
  made.asks_look_alike = true;
  made.look_alikes.otherwise = evidence_table::kOtherwise;
  made.look_alikes.alike = evidence_table::kAlike;
  made.look_alikes.otherwise_nats.fill(against_look_alike);
  made.look_alikes.alike_nats.fill(against_look_alike);
  return made;
}

/// Scans in a row, each linked with the next.
std::vector<PlacedPair> row(int scans, double against_look_alike) {
  std::vector<PlacedPair> pairs;
  for (int n = 1; n < scans; ++n) pairs.push_back({n, n - 1, 20.0, evidence(against_look_alike), n});
  return pairs;
}

double factor(int scans, const std::vector<PlacedPair>& pairs, const std::vector<UnusedLink>& unused = {}) {
  std::vector<bool> last(static_cast<std::size_t>(scans), false);
  last.back() = true;
  return LookAlikeRate(Viewpoints(scans), scans, pairs, unused).factor(last);
}

TEST(LookAlikeRate, WithoutOtherLinksIsTheOneBeforehand) {
  EXPECT_NEAR(factor(2, row(2, 5.0)), 1.0, 0.02);
}

TEST(LookAlikeRate, PairsThatSayNothingChangeLittle) {
  EXPECT_NEAR(factor(20, row(20, 0.0)), 1.0, 0.05);
}

/// A user's word that nothing repeats, or a wall between two stations, is no observation: bare rooms stay in
/// doubt however many there are.
TEST(LookAlikeRate, WhatIsBelievedOfLinksBeforehandSaysNothing) {
  std::vector<PlacedPair> pairs = row(30, 0.0);
  for (PlacedPair& pair : pairs) pair.evidence.look_alikes.otherwise /= 20.0;
  EXPECT_NEAR(factor(30, pairs), 1.0, 0.05);
}

TEST(LookAlikeRate, FallsWithTheNumberOfClearScans) {
  const double few = factor(5, row(5, 9.0));
  const double many = factor(40, row(40, 9.0));
  EXPECT_LT(few, 0.2);
  EXPECT_LT(many, 0.2 * few);
}

/// A scan with one link that says nothing and one that is clear is clear.
TEST(LookAlikeRate, OfEachScanTheClearestLinkCounts) {
  std::vector<PlacedPair> pairs = row(10, 9.0);
  const double clear = factor(10, pairs);
  for (int n = 2; n < 10; ++n) pairs.push_back({n, n - 2, 20.0, evidence(0.0), 10 + n});
  EXPECT_NEAR(factor(10, pairs), clear, 0.2 * clear);
}

/// Where poses of other links lie where the scans are not, the building has look-alike places.
TEST(LookAlikeRate, RisesWithLinksThatAreContradicted) {
  const std::vector<PlacedPair> pairs = row(20, 9.0);
  std::vector<UnusedLink> unused;
  double before = factor(20, pairs);
  for (int n = 3; n < 12; n += 4) {
    unused.push_back({n, n - 3, evidence(0.0), true});
    const double now = factor(20, pairs, unused);
    EXPECT_GT(now, 1.2 * before);
    before = now;
  }
}

/// A pose that probably agrees by chance says little of look-alike places.
TEST(LookAlikeRate, PosesByChanceCountLess) {
  const std::vector<PlacedPair> pairs = row(20, 9.0);
  std::vector<UnusedLink> unused = {{5, 2, evidence(0.0), true}};
  const double sure = factor(20, pairs, unused);
  unused.front().evidence.chance_nats = 0.1;
  EXPECT_LT(factor(20, pairs, unused), 0.7 * sure);
}

TEST(LookAlikeRate, DoesNotDependOnTheOrderOfLinks) {
  std::vector<PlacedPair> pairs = row(12, 4.0);
  for (std::size_t k = 0; k < pairs.size(); ++k) pairs[k].evidence = evidence(static_cast<double>(k));
  const double one = factor(12, pairs, {{5, 2, evidence(1.0), true}, {7, 1, evidence(0.0), false}});
  std::reverse(pairs.begin(), pairs.end());
  EXPECT_NEAR(factor(12, pairs, {{7, 1, evidence(0.0), false}, {5, 2, evidence(1.0), true}}), one, 1e-12);
}

}  // namespace
}  // namespace limen
