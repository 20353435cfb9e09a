// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/hear_around.h"

#include <algorithm>
#include <cmath>

#include "support/synthetic_graph.h"
#include <gtest/gtest.h>

#include "limen/project/graph/pose_graph.h"

namespace limen {
namespace {

/// Three scans that are sure of one another, and a fourth that hangs on one link to the first.
struct OfOneLink {
  SyntheticGraph made = synthetic_graph(3, 1, 2, 0.0, 8);

  OfOneLink(double twin, double chance) {
    RandomStream random(8, 1);
    made.graph.nodes = 4;
    // Each of them sees other walls.
    for (GraphLink& other : made.graph.links)
      for (LinkPose& pose : other.poses) pose.agreeing_m2 = 0.0;
    GraphLink link;
    link.source = 3;
    link.target = 0;
    link.twin = twin;
    link.chance = chance;
    link.trust = twin > 0.001 ? LinkTrust::likely : LinkTrust::sure;
    if (twin > 0.0) link.evidence = twin_evidence_of(twin);
    link.poses = {measured_pose(inverse(made.world_from_node[0]) * random_pose(random, 5.0), 10.0, random)};
    made.graph.links.push_back(link);
  }

  [[nodiscard]] SolvedNode solved(const PoseHearing& hearing) const {
    return solve_graph(made.graph, 0.001, hearing).nodes[3];
  }
};

/// What the fourth and some of the others say of one another.
PoseHearing hearing_of(const PoseHeard& surface, double otherwise_nats, std::vector<int> others = {2}) {
  const auto met = [others](int source, int target) {
    return source == 3 && std::find(others.begin(), others.end(), target) != others.end();
  };
  return {[=](int source, int target, const Rigid3& /*pose*/) {
            return met(source, target) ? surface : PoseHeard{};
          },
          [=](int source, int target, const Rigid3& /*pose*/) -> std::optional<TwinEvidence> {
            if (!met(source, target)) return std::nullopt;
            TwinEvidence said;
            said.otherwise_nats = otherwise_nats;
            said.alike_nats = 9.0;  // not heard: no pose that others found is known so well
            return said;
          }};
}

TEST(HearAround, SurfaceThatOthersMeetSpeaksAgainstChance) {
  const OfOneLink scans(0.0, 0.01);
  const double alone = scans.solved({}).doubt;
  EXPECT_EQ(scans.solved({}).state, NodeState::probable);
  const SolvedNode heard = scans.solved(hearing_of({3.0, 0.0, 3.0}, 0.0));
  EXPECT_EQ(heard.state, NodeState::registered);
  EXPECT_NEAR(heard.doubt, alone * std::exp(-3.0), 1e-5);
  // However much it is: wrong poses meet something as well.
  EXPECT_NEAR(scans.solved(hearing_of({40.0, 0.0, 40.0}, 0.0)).doubt, alone * std::exp(-5.0), 1e-5);
}

TEST(HearAround, WhatTwoScansSawOfTheSameCountsOnce) {
  const OfOneLink scans(0.0, 0.01);
  OfOneLink one_view = scans;
  // Scans 1 and 2 see the same walls.
  for (GraphLink& link : one_view.made.graph.links)
    if (link.source != 3 && link.source + link.target == 3) link.poses.front().agreeing_m2 = 100.0;
  const PoseHearing both = hearing_of({2.0, 0.0, 2.0}, 0.0, {1, 2});
  const double once = one_view.solved(hearing_of({2.0, 0.0, 2.0}, 0.0, {1})).doubt;
  EXPECT_NEAR(one_view.solved(both).doubt, once, 1e-6);
}

TEST(HearAround, ThingsThatOthersMeetSpeakAgainstATwinFurnishedOtherwise) {
  const OfOneLink scans(0.01, 0.0);
  const double alone = scans.solved({}).doubt;
  const double heard = scans.solved(hearing_of({1.0, 0.0, 1.0}, 4.0)).doubt;
  EXPECT_LT(heard, alone * 0.1);
  // Of twins furnished alike nothing was heard.
  const TwinEvidence before = twin_evidence_of(0.01);
  EXPECT_GT(heard, alone * 0.9 * before.alike / (before.alike + before.otherwise));
  EXPECT_GT(scans.solved(hearing_of({1.0, 0.0, 1.0}, -2.0)).doubt, alone * 2.0);
}

TEST(HearAround, OfAPlaceWhereOthersSawThroughNothingElseIsHeard) {
  const OfOneLink scans(0.0, 0.01);
  PoseHearing hearing = hearing_of({3.0, 0.0, 3.0}, 0.0);
  hearing.surface = [](int source, int target, const Rigid3& /*pose*/) -> PoseHeard {
    if (source != 3) return {};
    return target == 2 ? PoseHeard{3.0, 0.0, 3.0} : PoseHeard{0.0, 4.0, -16.0};
  };
  const SolvedNode heard = scans.solved(hearing);
  EXPECT_NE(heard.state, NodeState::registered);
  EXPECT_GT(heard.doubt, scans.solved({}).doubt);
}

TEST(HearAround, WhatStandsWhereOthersSawThroughIsInDoubtHoweverItIsHeld) {
  const OfOneLink scans(0.0, 1e-6);
  EXPECT_EQ(scans.solved({}).state, NodeState::registered);
  EXPECT_EQ(scans.solved(hearing_of({4.0, 1.9, 0.0}, 0.0)).state, NodeState::registered);  // a door moved
  EXPECT_EQ(scans.solved(hearing_of({4.0, 6.0, -20.0}, 0.0)).state, NodeState::ambiguous);
}

TEST(HearAround, OnlyThoseThatStandMoreSurelyAreAskedAndNoneThatALinkHolds) {
  const OfOneLink scans(0.0, 0.01);
  AcceptedPoses accepted;
  accepted.frame_from_node.resize(4);
  accepted.component = {0, 0, 0, 0};
  accepted.pose.assign(scans.made.graph.links.size(), 0);
  const PoseHearing hearing = hearing_of({3.0, 0.0, 3.0}, 0.0, {0, 1, 2});
  const auto heard = [&](const std::vector<double>& doubt) {
    return hear_around(scans.made.graph, accepted, doubt, 0.001, hearing);
  };
  ASSERT_EQ(heard({0.0, 0.0, 0.0, 0.1}).size(), 2U);
  EXPECT_EQ(heard({0.0, 0.0, 0.0, 0.1})[0].pair.target, 1);
  EXPECT_EQ(heard({0.0, 0.0, 0.0, 0.1})[1].pair.target, 2);
  EXPECT_EQ(heard({0.0, 0.01, 0.0, 0.1}).size(), 1U);
  EXPECT_TRUE(heard({0.0, 0.0, 0.0, 1e-4}).empty());  // nothing contradicts
}

}  // namespace
}  // namespace limen
