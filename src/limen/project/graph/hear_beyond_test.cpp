// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/hear_beyond.h"

#include <cmath>

#include <gtest/gtest.h>

namespace limen {
namespace {

/// Node 2 hangs on one link to node 0; node 1 stands as firmly as node 0.
struct HangsOnOneLink {
  PoseGraph graph;
  AcceptedPoses accepted{std::vector<Rigid3>(3), {0, 0, 0}, {0}};
  std::vector<NodeDoubt> doubts = std::vector<NodeDoubt>(3);
  std::vector<bool> firm{true, true, false};

  HangsOnOneLink() {
    for (NodeDoubt& doubt : doubts) doubt.twin = doubt.chance = 0.0;
    doubts[2].chance = 0.003;
    doubts[2].links = {0};
    graph.nodes = 3;
    GraphLink link;
    link.source = 2;
    link.target = 0;
    link.poses.emplace_back();
    graph.links.push_back(link);
  }

  [[nodiscard]] std::vector<double> heard(double beyond_m2) const {
    PoseHearing hearing;
    hearing.beyond = [beyond_m2](int source, const std::vector<NodePose>& held,
                                 const std::vector<NodePose>& others) {
      EXPECT_EQ(source, 2);
      EXPECT_EQ(held.size(), 1U);
      EXPECT_EQ(held.front().target, 0);
      EXPECT_EQ(others.size(), 2U);
      return beyond_m2;
    };
    return hear_beyond(graph, accepted, doubts, firm, 0.001, hearing);
  }
};

TEST(HearBeyond, SurfaceThatNoLinkHasShownSpeaksAgainstChance) {
  const HangsOnOneLink scans;
  EXPECT_EQ(scans.heard(0.0)[2], 0.0);
  EXPECT_NEAR(scans.heard(2.0)[2], 1.4, 1e-9);
  EXPECT_NEAR(scans.heard(50.0)[2], 3.0, 1e-9);  // as a further link at most
  EXPECT_EQ(scans.heard(-5.0)[2], 0.0);
  EXPECT_EQ(scans.heard(2.0)[0], 0.0);
}

TEST(HearBeyond, ADoubtOfATwinIsNoneOfChance) {
  HangsOnOneLink scans;
  scans.doubts[2].twin = 0.01;
  PoseHearing hearing;
  hearing.beyond = [](int, const std::vector<NodePose>&, const std::vector<NodePose>&) { return 5.0; };
  EXPECT_EQ(hear_beyond(scans.graph, scans.accepted, scans.doubts, scans.firm, 0.001, hearing)[2], 0.0);
}

TEST(HearBeyond, WhatIsSaidLessensTheDoubtOfTheNodeAlone) {
  HangsOnOneLink scans;
  scans.graph.links.front().chance = 0.003;
  const std::vector<int> reference{0, -1, 0};
  const double before = doubts_of(scans.graph, scans.accepted, reference)[2].chance;
  scans.accepted.beyond_nats = {0.0, 0.0, 1.0};
  EXPECT_NEAR(before, 0.003, 1e-9);
  EXPECT_NEAR(doubts_of(scans.graph, scans.accepted, reference)[2].chance, before * std::exp(-1.0), 1e-9);
}

}  // namespace
}  // namespace limen
