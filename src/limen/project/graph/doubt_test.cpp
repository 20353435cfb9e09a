// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/doubt.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "support/synthetic_graph.h"
#include <gtest/gtest.h>

namespace limen {
namespace {

/// Stations in a row, without links.
struct Row {
  explicit Row(int nodes) {
    graph.nodes = nodes;
    for (int k = 0; k < nodes; ++k) {
      Rigid3 pose;
      pose.translation = {3.0 * k, 0, 0};
      truth.push_back(pose);
    }
  }

  void link(int source, int target, double twin, double chance, double agreeing_m2 = 10.0) {
    const Rigid3 right =
        inverse(truth[static_cast<std::size_t>(target)]) * truth[static_cast<std::size_t>(source)];
    GraphLink made;
    made.source = source;
    made.target = target;
    made.trust = twin > 0.001 ? LinkTrust::likely : LinkTrust::sure;
    made.poses = {measured_pose(right, agreeing_m2, random)};
    made.twin = twin;
    made.chance = chance;
    graph.links.push_back(made);
  }

  PoseGraph graph;
  std::vector<Rigid3> truth;
  RandomStream random{3, 1};
};

/// What is probable counts as open: these tests are about what is surely held.
std::vector<NodeState> states_of(const SolvedGraph& solved) {
  std::vector<NodeState> states;
  for (const SolvedNode& node : solved.nodes)
    states.push_back(node.state == NodeState::probable ? NodeState::ambiguous : node.state);
  return states;
}

using States = std::vector<NodeState>;
constexpr NodeState kYes = NodeState::registered;
constexpr NodeState kOpen = NodeState::ambiguous;

TEST(Doubt, WhatOneDoubtfulBridgeHoldsIsNotRegistered) {
  for (const bool twin : {true, false}) {
    Row row(4);
    row.link(1, 0, 0.0, 0.0);
    row.link(2, 1, 0.0, 0.0);
    row.link(3, 2, twin ? 0.01 : 0.0, twin ? 0.0 : 0.01);
    const SolvedGraph solved = solve_graph(row.graph, 0.001);
    EXPECT_EQ(states_of(solved), (States{kYes, kYes, kYes, kOpen})) << twin;
    // Two others of three are held: it stands apart by odds of 2 : 3.
    EXPECT_NEAR(solved.nodes[3].doubt, twin ? 0.01 * 2.0 / 3.0 : 0.01, 1e-4);
    EXPECT_LT(solved.nodes[2].doubt, 1e-5);
    ASSERT_EQ(solved.questions.size(), 1U);
    EXPECT_EQ(solved.questions[0].moved, std::vector<int>{3});
    EXPECT_EQ(solved.questions[0].current, std::vector<int>{2});
    EXPECT_EQ(solved.links[2].state, LinkState::ambiguous);
    // Less than one in twenty leaves it probable, unless less is asked for.
    EXPECT_EQ(solved.nodes[3].state, NodeState::probable) << twin;
    EXPECT_EQ(solve_graph(row.graph, 0.001, {}, 0.005).nodes[3].state, NodeState::ambiguous) << twin;
    // Who bears more risk is told more.
    for (GraphLink& link : row.graph.links) link.trust = LinkTrust::sure;
    EXPECT_EQ(states_of(solve_graph(row.graph, 0.02)), (States{kYes, kYes, kYes, kYes})) << twin;
  }
}

TEST(Doubt, WhatWallsSayAgainstATwinCountsOnceForABuilding) {
  const auto odds_of = [](double built_nats, int links) {
    Row row(2);
    for (int k = 0; k < links; ++k) {
      row.link(1, 0, 0.02, 0.0, 10.0 + k);
      TwinEvidence said = twin_evidence_of(0.02);
      said.built_nats = built_nats;
      row.graph.links.back().evidence = said;
      row.graph.links.back().twin = said.probability();
    }
    const double doubt = solve_graph(row.graph, 0.001).nodes[1].doubt;
    return doubt / (1.0 - doubt);
  };
  EXPECT_NEAR(odds_of(0.0, 1), 0.02 / 0.98, 1e-4);
  EXPECT_NEAR(odds_of(std::log(20.0), 1), odds_of(0.0, 1) / 20.0, 1e-5);
  EXPECT_NEAR(odds_of(std::log(20.0), 2), odds_of(0.0, 2) / 20.0, 1e-5);
}

TEST(Doubt, WhatWallsSayIsAskedOfTheLinkThatShowsMost) {
  const auto odds_of = [](double of_the_smaller, double of_the_larger) {
    Row row(2);
    for (const auto& [built_nats, agreeing_m2] :
         {std::pair(of_the_smaller, 10.0), std::pair(of_the_larger, 40.0)}) {
      row.link(1, 0, 0.02, 0.0, agreeing_m2);
      row.graph.links.back().evidence = twin_evidence_of(0.02);
      row.graph.links.back().evidence->built_nats = built_nats;
    }
    const double doubt = solve_graph(row.graph, 0.001).nodes[1].doubt;
    return doubt / (1.0 - doubt);
  };
  EXPECT_NEAR(odds_of(std::log(20.0), 0.0), odds_of(0.0, 0.0), 1e-6);
  EXPECT_NEAR(odds_of(0.0, std::log(20.0)), odds_of(0.0, 0.0) / 20.0, 1e-5);
}

/// A terrace of houses that are furnished alike: things tell each pair apart from what is furnished
/// otherwise, faces tell nothing. However many such pairs there are, the last is not held more surely for
/// them; those that faces tell are taken for a sign that twins are not furnished alike here.
TEST(Doubt, HowSeldomTwinsAreFurnishedAlikeIsLearnedFromWhatSpeaksOfThem) {
  const auto doubt_beside = [](int pairs, double alike_nats, bool twins = false) {
    Row row(pairs + 2);
    if (twins) {
      row.link(2, 0, 0.9, 0.0);
      row.graph.links.back().evidence = twin_evidence_of(0.9);
      row.graph.against.push_back(row.graph.links.back());
      row.graph.links.clear();
    }
    for (int k = 0; k <= pairs; ++k) {
      const bool last = k == pairs;
      TwinEvidence said;
      said.otherwise_nats = 9.0;
      said.alike_nats = last ? 0.0 : alike_nats;
      row.link(k + 1, k, said.probability(), 0.0);
      row.graph.links.back().evidence = said;
    }
    AcceptedPoses accepted{row.truth, std::vector<int>(row.truth.size(), 0),
                           std::vector<int>(row.graph.links.size(), 0)};
    return doubts_of(row.graph, accepted, std::vector<int>(row.truth.size(), 0)).back().twin;
  };
  const double alone = doubt_beside(0, 0.0);
  EXPECT_NEAR(alone, 0.0045 / 0.85, 2e-4);
  EXPECT_GT(doubt_beside(10, 0.0), 0.85 * alone);
  EXPECT_LT(doubt_beside(10, 9.0), 0.2 * alone);
  // Where places are built alike other rooms alone do not settle it.
  EXPECT_GT(doubt_beside(10, 9.0, true), 0.0019);
}

/// Station 1 is held to the frame's two stations, by one link that speaks against a twin and one that speaks
/// for it; station 3 hangs on it by a link that speaks against one by less than the former. It stands no more
/// surely than what it hangs on.
TEST(Doubt, WhatHangsOnADoubtfulScanIsAsDoubtful) {
  Row row(4);
  row.link(2, 0, 0.0, 0.0, 1.0);
  const auto link = [&](int source, int target, double otherwise_nats, double agreeing_m2) {
    TwinEvidence said;
    said.otherwise_nats = otherwise_nats;
    said.alike_nats = 12.0;
    row.link(source, target, said.probability(), 0.0, agreeing_m2);
    row.graph.links.back().evidence = said;
  };
  link(1, 0, 3.0, 10.0);
  link(1, 2, -2.5, 5.0);
  link(3, 1, 2.5, 10.0);
  const AcceptedPoses accepted{row.truth, {0, 0, 0, 0}, {0, 0, 0, 0}};
  const std::vector<NodeDoubt> doubts = doubts_of(row.graph, accepted, {0, 0, 0, 0});
  EXPECT_GT(doubts[1].twin, 1e-3);
  EXPECT_NEAR(doubts[3].twin, doubts[1].twin, 1e-5);
  EXPECT_EQ(doubts[3].links, doubts[1].links);
}

TEST(Doubt, LinksThatSeeDifferentSurfaceCheckOneAnotherWhereChanceIsFeared) {
  Row row(3);
  row.link(1, 0, 0.0, 0.0, 4.0);
  row.link(2, 0, 0.0, 0.05);
  row.link(2, 1, 0.0, 0.05);
  EXPECT_EQ(states_of(solve_graph(row.graph)), (States{kYes, kYes, kYes}));
  // The same where both ends see the same room: one witness.
  Row room(3);
  room.link(1, 0, 0.0, 0.0, 50.0);
  room.link(2, 0, 0.0, 0.05);
  room.link(2, 1, 0.0, 0.05);
  EXPECT_EQ(states_of(solve_graph(room.graph)), (States{kYes, kYes, kOpen}));
}

TEST(Doubt, OneOfSeveralPosesIsNoSurerThanThePairTakesItFor) {
  // Two passes see one facade: what fits it in one of two places fits both passes there.
  Row row(3);
  row.link(1, 0, 0.0, 0.0, 400.0);
  for (const int pass : {0, 1}) {
    row.link(2, pass, 0.0, 0.0);
    GraphLink& link = row.graph.links.back();
    link.trust = LinkTrust::open;
    link.poses.front().probability = 0.6;
  }
  EXPECT_EQ(states_of(solve_graph(row.graph)), (States{kYes, kYes, kOpen}));
}

TEST(Doubt, LoopsOfPlacesBuiltAlikeProveNothing) {
  Row row(3);
  row.link(1, 0, 0.005, 0.0);
  row.link(2, 0, 0.005, 0.0);
  row.link(2, 1, 0.005, 0.0);
  const SolvedGraph solved = solve_graph(row.graph);
  EXPECT_EQ(states_of(solved), (States{kYes, kOpen, kOpen}));
  for (const SolvedLink& link : solved.links) EXPECT_NE(link.state, LinkState::verified);
}

TEST(Doubt, ATwinIsBelievedOnceAndRefutedByEveryLinkThatSeesOtherThings) {
  Row row(3);
  row.link(1, 0, 0.0, 0.0, 0.5);
  row.link(2, 0, 0.01, 0.0);
  row.link(2, 1, 0.01, 0.0);
  const SolvedGraph solved = solve_graph(row.graph);
  EXPECT_EQ(states_of(solved), (States{kYes, kYes, kYes}));
  // Odds of 0.15 : 0.85 beforehand, which each link makes less, and but for the 5 % that both see.
  const double factor = (0.01 / 0.99) / (0.15 / 0.85);
  EXPECT_NEAR(solved.nodes[2].doubt, 0.15 / 0.85 * std::pow(factor, 1.95), 1e-5);
}

TEST(Doubt, ATwinIsRarerTheFewerScansStandApart) {
  const auto doubt_with = [](int held, int floating, bool twin) {
    Row row(1 + held + floating + 1);
    for (int k = 1; k <= held; ++k) row.link(k, k - 1, 0.0, 0.0);
    row.link(row.graph.nodes - 1, 0, twin ? 0.004 : 0.0, twin ? 0.0 : 0.004);
    return solve_graph(row.graph, 0.001).nodes.back().doubt;
  };
  EXPECT_NEAR(doubt_with(0, 0, true), 0.004, 1e-5);
  EXPECT_NEAR(doubt_with(10, 0, true), 0.004 * 2.0 / 11.0, 1e-5);
  EXPECT_NEAR(doubt_with(10, 3, true), 0.004 * 5.0 / 11.0, 1e-5);
  EXPECT_NEAR(doubt_with(3, 10, true), 0.004, 1e-5);
  // That a link is wrong by chance does not depend on the others.
  EXPECT_NEAR(doubt_with(10, 0, false), 0.004, 1e-5);
}

TEST(Doubt, WhatHasBeenLearnedOfTheBuildingSettlesWhereAScanStands) {
  // Two pairs hold the last scan in one place, each of which a twin explains once in a hundred times, and a
  // third says it stands 2 m off.
  const auto solved_with = [](int held) {
    Row row(held + 1);
    for (std::size_t k = 0; k < row.truth.size(); ++k)
      row.truth[k].translation = {3.0 * static_cast<double>(k % 10), 0.3 * static_cast<double>(k), 0};
    for (int k = 1; k < held; ++k) row.link(k, k - std::min(k, 10), 0.0, 0.0, 0.5);
    row.link(held, held - 1, 0.01, 0.0);
    row.link(held, held - 2, 0.01, 0.0);
    row.link(held, held - 3, 0.0, 0.05, 6.0);
    row.graph.links.back().poses.front().target_from_source.translation.y() += 2.0;
    return solve_graph(row.graph, 0.001);
  };
  const SolvedGraph few = solved_with(5);
  ASSERT_EQ(few.questions.size(), 1U);
  EXPECT_EQ(few.questions[0].moved, std::vector<int>{5});
  EXPECT_EQ(few.questions[0].rival.size(), 1U);
  EXPECT_NE(few.nodes.back().state, kYes);
  // In a building whose scans all hang together twins are rare.
  const SolvedGraph many = solved_with(100);
  EXPECT_TRUE(many.questions.empty());
  EXPECT_EQ(many.nodes.back().state, kYes);
}

TEST(Doubt, TheDoubtOfASideIsThatOfTheLinksAcross) {
  Row row(4);
  row.link(1, 0, 0.0, 0.0, 0.5);
  row.link(3, 2, 0.0, 0.0, 0.5);
  row.link(2, 1, 0.01, 0.0);
  row.link(3, 0, 0.0, 0.02);
  const SolvedGraph solved = solve_graph(row.graph);
  AcceptedPoses accepted;
  for (const SolvedLink& link : solved.links) accepted.pose.push_back(link.pose);
  for (const SolvedNode& node : solved.nodes) {
    accepted.frame_from_node.push_back(node.frame_from_node);
    accepted.component.push_back(node.component);
  }
  const std::vector<bool> side{false, false, true, true};
  const NodeDoubt both = doubt_of_side(row.graph, accepted, side);
  EXPECT_LT(both.total(), 0.001);
  // Without the link that no twin explains, a twin does; without the other, chance.
  accepted.pose[3] = -1;
  EXPECT_NEAR(doubt_of_side(row.graph, accepted, side).twin, 0.01, 1e-6);
  EXPECT_LT(doubt_of_side(row.graph, accepted, side).chance, 1e-6);
  accepted.pose[3] = 0;
  accepted.pose[2] = -1;
  EXPECT_NEAR(doubt_of_side(row.graph, accepted, side).chance, 0.02, 1e-6);
}

TEST(Doubt, WhatSpeaksForATwinCountsToo) {
  Row row(3);
  row.link(1, 0, 0.0002, 0.0);
  row.link(2, 1, 0.0005, 0.0);
  EXPECT_EQ(states_of(solve_graph(row.graph)), (States{kYes, kYes, kYes}));
  row.link(2, 0, 0.9, 0.0);
  row.graph.against.push_back(row.graph.links.back());
  row.graph.against.back().evidence = twin_evidence_of(0.9);
  row.graph.links.pop_back();
  // 2 may stand elsewhere, alone or with 1.
  EXPECT_EQ(states_of(solve_graph(row.graph)), (States{kYes, kOpen, kOpen}));
  // A pair whose twin would stand elsewhere than the solution says nothing of it.
  row.graph.against.back().poses.front().target_from_source.translation.y() += 5.0;
  EXPECT_EQ(states_of(solve_graph(row.graph)), (States{kYes, kYes, kYes}));
}

TEST(Doubt, HoweverMuchSpeaksForATwinItsProbabilityIsANumber) {
  Row row(162);
  for (int k = 0; k < 80; ++k) {
    // Two storeys, all rooms of which say that they are twins.
    row.link(2 * k + 2, 2 * k, 0.0, 0.0, 0.0);
    row.link(2 * k + 3, 2 * k + 1, 0.0, 0.0, 0.0);
    row.link(2 * k + 1, 2 * k, 0.9, 0.0);
    GraphLink pair = row.graph.links.back();
    row.graph.links.pop_back();
    pair.evidence = TwinEvidence{0.1455, 0.0045, -10.0, -10.0};
    row.graph.against.push_back(pair);
  }
  row.link(161, 160, 0.05, 0.0);
  AcceptedPoses accepted;
  accepted.pose.assign(row.graph.links.size(), 0);
  accepted.frame_from_node = row.truth;
  accepted.component.assign(162, 0);
  std::vector<bool> side;
  for (int k = 0; k < 162; ++k) side.push_back(k % 2 == 1);
  const NodeDoubt doubt = doubt_of_side(row.graph, accepted, side);
  EXPECT_GT(doubt.twin, 0.999);
  EXPECT_LE(doubt.twin, 1.0);
}

TEST(Doubt, WhatIsRatherATwinIsTakenApartAndLeavesTheOthersSure) {
  // 3 and 4 are of one room. A bare pair lays them on 1, and pairs with other scans there say: twins.
  Row row(5);
  row.link(1, 0, 0.0, 0.0, 4.0);
  row.link(2, 1, 0.0002, 0.0);
  row.link(4, 3, 0.0002, 0.0);
  row.link(3, 1, 0.15, 0.0);
  for (const auto& [source, target] : {std::pair(4, 1), std::pair(3, 2)}) {
    row.link(source, target, 0.99, 0.0);
    row.graph.against.push_back(row.graph.links.back());
    row.graph.against.back().evidence = twin_evidence_of(0.99);
    row.graph.links.pop_back();
  }
  const SolvedGraph solved = solve_graph(row.graph);
  for (const std::size_t node : {std::size_t{0}, std::size_t{1}, std::size_t{2}}) {
    EXPECT_EQ(solved.nodes[node].state, kYes) << node;
    EXPECT_EQ(solved.nodes[node].component, 0) << node;
  }
  EXPECT_EQ(solved.nodes[3].component, 1);
  EXPECT_EQ(solved.nodes[4].component, 1);
  EXPECT_LT(solved.links[3].pose, 0);
}

TEST(Doubt, WhatAWeakLinkHoldsIsOpenOnlyAsFarAsTheLinkIsSure) {
  for (const double chance : {1e-5, 0.3}) {
    Row row(3);
    row.link(1, 0, 0.0, 0.0);
    row.link(2, 1, 0.0, chance);
    GraphLink& weak = row.graph.links.back();
    weak.trust = LinkTrust::weak;
    weak.poses.front().covariance(3, 3) = 1e4;
    const SolvedGraph solved = solve_graph(row.graph, 0.001);
    EXPECT_EQ(solved.nodes[2].state, chance > 0.001 ? kOpen : NodeState::under_constrained);
    EXPECT_NEAR(solved.nodes[2].doubt, chance, 1e-5);
    EXPECT_EQ(solved.nodes[1].state, kYes);
  }
}

TEST(Doubt, TheFrameIsNotLentAcrossALinkThatMayBeChance) {
  Row row(4);
  row.link(1, 0, 0.0, 0.02);
  row.graph.links.back().trust = LinkTrust::sure;
  row.link(2, 1, 0.0, 0.0);
  row.link(3, 2, 0.0, 0.0);
  EXPECT_EQ(states_of(solve_graph(row.graph, 0.001)), (States{kOpen, kYes, kYes, kYes}));
}

TEST(Doubt, TheLargestSurePartLendsTheFrame) {
  Row row(4);
  row.link(1, 0, 0.02, 0.0);
  row.link(2, 1, 0.0, 0.0);
  row.link(3, 2, 0.0, 0.0);
  EXPECT_EQ(states_of(solve_graph(row.graph)), (States{kOpen, kYes, kYes, kYes}));
}

}  // namespace
}  // namespace limen
