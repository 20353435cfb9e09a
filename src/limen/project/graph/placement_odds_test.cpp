// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/placement_odds.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <set>
#include <utility>

#include <gtest/gtest.h>

namespace limen {
namespace {

PlacedPair pair(int source, int target, double chance_nats, double otherwise_nats, double alike_nats,
                int link, double shared_m2 = 20.0) {
  PlacedPair made{source, target, shared_m2, {}, link};
  made.evidence.chance_nats = chance_nats;
  made.evidence.coincidence_nats = 6.9;
  made.evidence.asks_look_alike = true;
  made.evidence.look_alikes.otherwise_nats.fill(otherwise_nats);
  made.evidence.look_alikes.alike_nats.fill(alike_nats);
  return made;
}

std::vector<bool> side(std::initializer_list<int> nodes, std::size_t count) {
  std::vector<bool> all(count, false);
  for (const int n : nodes) all[static_cast<std::size_t>(n)] = true;
  return all;
}

/// Of a single pair the odds are what the pair itself says.
TEST(PlacementOdds, OfOnePairAreThePairs) {
  const PlacedPair only = pair(1, 0, 5.0, 3.0, 1.0, 0);
  PlacementOdds odds(2, {only});
  const SideOdds& said = odds.of(side({1}, 2));
  EXPECT_NEAR(said.chance, std::exp(-5.0), 1e-9);
  EXPECT_NEAR(said.look_alike, odds_of(only.evidence.look_alikes), 0.2 * odds_of(only.evidence.look_alikes));
}

/// Windows of a look-alike room agree by design, in part: a second pair excludes chance sooner than such a
/// room.
TEST(PlacementOdds, ASecondPairThroughWindowsExcludesChanceSoonerThanALookAlikeRoom) {
  const auto through_windows = [](int target, int link) {
    PlacedPair made = pair(2, target, 6.0, 1.0, 1.0, link);
    made.evidence.look_alikes.rooms = false;
    made.evidence.look_alikes.otherwise = 0.5;
    return made;
  };
  PlacementOdds one(3, {through_windows(0, 0)});
  PlacementOdds two(3, {through_windows(0, 0), through_windows(1, 1)});
  const SideOdds& by_one = one.of(side({2}, 3));
  const SideOdds& by_two = two.of(side({2}, 3));
  EXPECT_LT(by_two.chance, 1e-3 * by_one.chance);
  EXPECT_GT(by_two.look_alike / by_one.look_alike, 100.0 * by_two.chance / by_one.chance);
  EXPECT_LT(by_two.look_alike, 0.1 * by_one.look_alike);
}

/// That there is a look-alike place is believed once for a side, what is seen against it counts for each
/// pair.
TEST(PlacementOdds, EvidenceOfPairsThatShowDifferentThingsMultiplies) {
  PlacementOdds one(3, {pair(2, 0, 5.0, 4.0, 2.0, 0)});
  PlacementOdds two(3, {pair(2, 0, 5.0, 4.0, 2.0, 0), pair(2, 1, 5.0, 4.0, 2.0, 1)});
  const std::vector<bool> alone = side({2}, 3);
  EXPECT_NEAR(std::log(one.of(alone).look_alike / two.of(alone).look_alike), 3.0, 1.1);
  EXPECT_NEAR(std::log(one.of(alone).chance / two.of(alone).chance), 5.0 + 6.9, 0.2);
}

/// Two scanner positions in one place see what a third one sees twice, but it is the same.
TEST(PlacementOdds, TheSameSurfaceSeenTwiceCountsOnce) {
  PlacementOdds different(3, {pair(2, 0, 5.0, 4.0, 2.0, 0), pair(2, 1, 5.0, 4.0, 2.0, 1)});
  PlacementOdds same(
      3, {pair(2, 0, 5.0, 4.0, 2.0, 0), pair(2, 1, 5.0, 4.0, 2.0, 1), pair(1, 0, 9.0, 9.0, 9.0, 2)});
  const std::vector<bool> alone = side({2}, 3);
  EXPECT_GT(same.of(alone).look_alike, 3.0 * different.of(alone).look_alike);
}

/// A pose that a file states does not depend on surface: another pair of the same two scans takes nothing of
/// its certainty away.
TEST(PlacementOdds, AStatedPoseIsAsCertainBesideAMeasuredPair) {
  PlacedPair stated{1, 0, 0.0, {}, 1};
  stated.evidence.chance_nats = 13.8;
  stated.evidence.coincidence_nats = 6.9;
  stated.evidence.stated = true;
  PlacementOdds beside(2, {pair(1, 0, 3.0, 2.0, 2.0, 0), stated});
  EXPECT_LT(beside.of(side({1}, 2)).total(), 1e-5);
  stated.evidence.stated = false;
  PlacementOdds as_surface(2, {pair(1, 0, 3.0, 2.0, 2.0, 0), stated});
  EXPECT_GT(as_surface.of(side({1}, 2)).total(), 1e-3);
}

/// What contradicts a placement makes it less probable, whatever agrees.
TEST(PlacementOdds, APairThatContradictsCounts) {
  PlacementOdds without(3, {pair(2, 0, 6.0, 3.0, 3.0, 0)});
  PlacementOdds with(3, {pair(2, 0, 6.0, 3.0, 3.0, 0), pair(2, 1, -8.0, -8.0, -8.0, -1)});
  const std::vector<bool> alone = side({2}, 3);
  EXPECT_GT(with.of(alone).total(), 100.0 * without.of(alone).total());
}

/// In a building whose scans show no look-alike places the next one is believed less.
TEST(PlacementOdds, HowOftenPlacesRepeatIsLearned) {
  std::vector<PlacedPair> pairs;
  for (int n = 1; n < 30; ++n)
    pairs.push_back(pair(n, n - 1, 9.0, n == 29 ? 0.0 : 9.0, n == 29 ? 0.0 : 9.0, n));
  PlacementOdds many(30, pairs);
  PlacementOdds few(2, {pair(1, 0, 9.0, 0.0, 0.0, 0)});
  EXPECT_LT(many.of(side({29}, 30)).look_alike, 0.25 * few.of(side({1}, 2)).look_alike);
}

/// Pairs that show the same count once together, each by what it shows, and not the one that says most.
TEST(PlacementOdds, TheOrderOfPairsDoesNotCount) {
  std::vector<PlacedPair> pairs = {pair(2, 0, 5.0, 6.0, 2.0, 0), pair(2, 1, 5.0, 1.0, -1.0, 1),
                                   pair(1, 0, 9.0, 9.0, 9.0, 2)};
  for (PlacedPair& one : pairs) one.evidence.look_alikes.things = 10.0;
  const std::vector<bool> alone = side({2}, 3);
  const double odds = PlacementOdds(3, pairs).of(alone).look_alike;
  std::swap(pairs[0], pairs[1]);
  EXPECT_NEAR(PlacementOdds(3, pairs).of(alone).look_alike, odds, 1e-9 * odds);
  std::vector<PlacedPair> equal = pairs;
  equal[0].evidence.look_alikes = equal[1].evidence.look_alikes;
  EXPECT_LT(PlacementOdds(3, equal).of(alone).look_alike, odds);
}

/// What bent scans show of how walls were built is no evidence. By how much they are bent the other pairs
/// show, not the one that is judged.
TEST(PlacementOdds, ByHowMuchScansAreBentIsLearnedFromTheOthers) {
  BuiltEvidence exact;  // pairs of a sensor that bends by the least amount ...
  exact.one = {20.0, 10.0, 5.0, 0.0, 0.0, 0.0, 4.0};
  BuiltEvidence bending;  // ... and of one that bends by the largest two
  bending.one = {-40.0, -30.0, -20.0, -10.0, -1.0, 0.0, -8.0};
  BuiltEvidence judged;  // walls that differ: in two places, if the sensor is exact
  judged.one = {-4.0, -3.0, -2.0, -1.0, 0.0, 0.0, 0.0};
  const auto odds = [](int nodes, const BuiltEvidence& others, const BuiltEvidence& last) {
    std::vector<PlacedPair> pairs;
    for (int n = 1; n < nodes; ++n) {
      pairs.push_back(pair(n, n - 1, 9.0, 4.0, 4.0, n));
      pairs.back().evidence.look_alikes.built = n == nodes - 1 ? last : others;
    }
    return PlacementOdds(nodes, pairs).of(side({nodes - 1}, static_cast<std::size_t>(nodes))).look_alike;
  };
  EXPECT_GT(odds(10, exact, judged), 3.0 * odds(10, exact, {}));
  EXPECT_NEAR(odds(10, bending, judged), odds(10, bending, {}), 0.1 * odds(10, bending, {}));
  EXPECT_LT(odds(10, exact, exact), 0.01 * odds(10, exact, {}));
  // Alone it is judged by what is believed of any sensor.
  EXPECT_NEAR(odds(2, {}, judged) / odds(2, {}, {}), std::exp(-built_nats(judged)), 1e-6);
}

/// Two houses, in each of which two scans are not bent. That all pairs of one to the other are bent is far
/// less probable than that one is.
TEST(PlacementOdds, EachPairIsBentForItself) {
  BuiltEvidence exact;  // of one place
  exact.one = {0.0, -20.0, -30.0, -40.0, -50.0, -60.0, -20.0};
  exact.look_alike = {-20.0, -25.0, -30.0, -40.0, -50.0, -60.0, -20.0};
  exact.as_drawn.fill(-100.0);
  BuiltEvidence differing;  // of two places, or bent so far that walls say nothing
  differing.one = {-24.0, -20.0, -16.0, -12.0, -8.0, -4.0, 0.0};
  differing.look_alike = {0.0, -1.0, -2.0, -3.0, -4.0, -4.0, 0.0};
  differing.as_drawn.fill(-100.0);
  const auto odds = [&](const std::vector<std::pair<int, int>>& across) {
    std::vector<PlacedPair> pairs = {pair(1, 0, 9.0, 4.0, 4.0, 0), pair(3, 2, 9.0, 4.0, 4.0, 1)};
    for (PlacedPair& within : pairs) within.evidence.look_alikes.built = exact;
    for (const auto& [source, target] : across) {
      pairs.push_back(pair(source, target, 9.0, 4.0, 4.0, static_cast<int>(pairs.size())));
      pairs.back().evidence.look_alikes.built = differing;
    }
    return PlacementOdds(4, pairs).of(side({2, 3}, 4)).look_alike;
  };
  const double one = odds({{2, 0}});
  EXPECT_GT(odds({{2, 0}, {3, 0}, {2, 1}, {3, 1}}), 20.0 * one);
}

/// A row of places, or places that all see one another, with `times` scans from each. A side is as surely
/// where it is as in the row of single scans: its pairs are the same ones again, and that copies agree says
/// nothing of a building.
TEST(PlacementOdds, ASecondViewFromOnePlaceMakesNothingSurer) {
  const auto odds = [](int times, bool known, int reach) {
    constexpr int kPlaces = 6;
    PoseGraph graph;
    graph.nodes = kPlaces * times;
    Configuration configuration;
    std::vector<PlacedPair> pairs;
    const auto n = static_cast<std::size_t>(graph.nodes);
    configuration.component.assign(n, 0);
    configuration.frame_from_node.resize(n);
    std::vector<bool> last(n, false);
    for (int a = 0; a < graph.nodes; ++a) {
      graph.scanners.emplace_back(Vector3d(5.0 * (a / times), 0.0, 0.01 * (a % times)));
      last[static_cast<std::size_t>(a)] = a / times == kPlaces - 1;
      for (int b = 0; b < a; ++b) {
        const int steps = a / times - b / times;
        if (steps > reach) continue;
        const double nats = steps == 0 ? 30.0 : 3.0;
        pairs.push_back(pair(a, b, steps == 0 ? 9.2 : 4.0, nats, nats, static_cast<int>(pairs.size())));
      }
    }
    return PlacementOdds(graph.nodes, pairs, {},
                         known ? std::optional(Viewpoints(graph, configuration)) : std::nullopt)
        .of(last)
        .total();
  };
  for (const int reach : {1, 5}) {
    EXPECT_NEAR(odds(3, true, reach), odds(1, true, reach), 0.25 * odds(1, true, reach)) << reach;
    EXPECT_LT(odds(3, false, reach), 0.3 * odds(1, false, reach)) << reach;
  }
}

/// How many things stay where they are is learned from the other pairs: where nearly all stay, a pair of
/// which half agree is sooner of two places.
TEST(PlacementOdds, HowManyThingsStayIsLearnedFromTheOthers) {
  const auto odds = [](double others_agree) {
    std::vector<PlacedPair> pairs;
    for (int n = 1; n < 10; ++n) {
      pairs.push_back(pair(n, n - 1, 9.0, 4.0, 4.0, n));
      LookAlikeEvidence& look_alikes = pairs.back().evidence.look_alikes;
      look_alikes.things = 20.0;
      look_alikes.agreeing = n == 9 ? 10.0 : 20.0 * others_agree;
    }
    return PlacementOdds(10, pairs).of(side({9}, 10)).look_alike;
  };
  EXPECT_GT(odds(0.97), 5.0 * odds(0.5));
  EXPECT_LT(odds(0.5), 1.1 * odds(0.6));
}

/// Rooms that look alike are excluded by a view through windows no better than it excludes chance.
TEST(PlacementOdds, AWeakViewThroughWindowsExcludesNoLookAlikeRoom) {
  const auto odds = [](double chance_nats) {
    PlacedPair windows = pair(2, 1, chance_nats, 0.0, 0.0, 1);
    windows.evidence.look_alikes.rooms = false;
    windows.evidence.look_alikes.otherwise = 0.01;
    return PlacementOdds(3, {pair(2, 0, 9.0, 2.0, 2.0, 0), windows}).of(side({2}, 3)).look_alike;
  };
  EXPECT_GT(odds(0.2), 20.0 * odds(8.0));
}

/// Each pair on the way to a scan may join a wrong place.
TEST(PlacementOdds, DoubtsAddUpAlongAChain) {
  std::vector<PlacedPair> pairs;
  for (int n = 1; n < 4; ++n) pairs.push_back(pair(n, n - 1, 5.0, 3.0, 1.0, n));
  PlacementOdds odds(4, pairs);
  const double last = odds.of(side({3}, 4)).total();
  const double all = last + odds.of(side({2, 3}, 4)).total() + odds.of(side({1, 2, 3}, 4)).total();
  const std::vector<double> of_nodes = odds.of_nodes({0, 0, 0, 0}, {}, 0.001);
  EXPECT_EQ(of_nodes[0], 0.0);
  EXPECT_NEAR(of_nodes[3], all, 1e-9 * all);
  EXPECT_NEAR(of_nodes[3] - of_nodes[2], last, 1e-9 * all);
  // Another scan lends the frame: the same pairs are on the way.
  EXPECT_NEAR(odds.of_nodes({3, 3, 3, 3}, {}, 0.001)[0], all, 1e-9 * all);
}

/// Whether a building has places furnished alike is one question, however many pairs are on the way.
TEST(PlacementOdds, PairsOnTheWayAskOnceForPlacesFurnishedAlike) {
  std::vector<PlacedPair> pairs;
  for (int n = 1; n < 6; ++n) {
    pairs.push_back(pair(n, n - 1, 30.0, 30.0, 0.0, n));
    pairs.back().evidence.look_alikes.otherwise = 0.9;
    pairs.back().evidence.look_alikes.alike = 0.005;
  }
  PlacementOdds odds(6, pairs);
  const std::vector<int> reference(6, 0);
  const std::vector<double> drawn = odds.of_nodes(reference, {}, 0.001);
  const double one = drawn[1];
  EXPECT_GT(one, 1e-5);
  EXPECT_NEAR(drawn[2], 1.5 * one, 0.1 * one);
  EXPECT_NEAR(drawn[5], 2.0 * one, 0.2 * one);
  std::set<std::vector<bool>> all;
  for (int n = 1; n < 6; ++n) {
    std::vector<bool> moved(6, false);
    for (int k = n; k < 6; ++k) moved[static_cast<std::size_t>(k)] = true;
    all.insert(moved);
  }
  EXPECT_NEAR(odds.of_nodes(reference, all, 0.001)[5], drawn[5], 0.4 * drawn[5]);
  // A joint that the others do not resemble keeps its odds.
  for (int n = 0; n < 4; ++n) pairs[static_cast<std::size_t>(n)].evidence.look_alikes.alike_nats.fill(9.0);
  PlacementOdds weak(6, pairs);
  EXPECT_GT(weak.of_nodes(reference, {}, 0.001)[5], 0.9 * weak.of(side({5}, 6)).total());
}

/// The sum over all sides is the same where sides are listed and where trees are drawn.
TEST(PlacementOdds, SidesThatAreNotFoundCountAsWell) {
  constexpr int kNodes = 5;
  std::vector<PlacedPair> pairs;
  for (int a = 0; a < kNodes; ++a) {
    for (int b = 0; b < a; ++b)
      pairs.push_back(pair(a, b, 4.0, 0.4 * a, 0.2 * b, static_cast<int>(pairs.size())));
  }
  PlacementOdds odds(kNodes, pairs);
  std::set<std::vector<bool>> all;
  for (int bits = 1; bits < 1 << (kNodes - 1); ++bits) {
    std::vector<bool> moved(kNodes, false);
    for (int n = 1; n < kNodes; ++n) moved[static_cast<std::size_t>(n)] = (bits >> (n - 1) & 1) != 0;
    all.insert(moved);
  }
  const std::vector<int> reference(kNodes, 0);
  const std::vector<double> listed = odds.of_nodes(reference, all, 0.001);
  const std::vector<double> drawn = odds.of_nodes(reference, {}, 0.001);
  const std::vector<double> some = odds.of_nodes(reference, {side({4}, kNodes), side({1, 2}, kNodes)}, 0.001);
  for (std::size_t n = 1; n < kNodes; ++n) {
    EXPECT_NEAR(drawn[n], listed[n], 0.3 * listed[n]);
    EXPECT_NEAR(some[n], listed[n], 0.3 * listed[n]);
  }
}

/// What is seen from many other scans is elsewhere in fewer ways than what a single pair joins.
TEST(PlacementOdds, ASideThatManyPairsJoinIsSeldomJoinedByOneAlone) {
  std::vector<PlacedPair> pairs;
  for (int a = 0; a < 8; ++a) {
    for (int b = 0; b < a; ++b) pairs.push_back(pair(a, b, 9.0, 3.0, 3.0, static_cast<int>(pairs.size())));
  }
  EXPECT_LT(PlacementOdds(8, pairs).of(side({1, 4, 6, 7}, 8)).share, 0.02);
  EXPECT_EQ(PlacementOdds(2, {pairs.front()}).of(side({1}, 2)).share, 1.0);
}

/// A storey that hangs on one staircase is one side.
TEST(PlacementOdds, WeakSidesHoldWhatHangsTogether) {
  std::vector<PlacedPair> pairs = {pair(1, 0, 9, 9, 9, 0), pair(2, 1, 9, 9, 9, 1), pair(2, 0, 9, 9, 9, 2),
                                   pair(4, 3, 9, 9, 9, 3), pair(5, 4, 9, 9, 9, 4), pair(5, 3, 9, 9, 9, 5),
                                   pair(3, 2, 3, 1, 0, 6)};
  const PlacementOdds odds(6, pairs);
  const std::set<std::vector<bool>> sides = odds.weak_sides({0, 0, 0, 0, 0, 0});
  EXPECT_NE(std::find(sides.begin(), sides.end(), side({3, 4, 5}, 6)), sides.end());
}

}  // namespace
}  // namespace limen
