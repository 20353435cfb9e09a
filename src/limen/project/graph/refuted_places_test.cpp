// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/refuted_places.h"

#include <utility>

#include "support/synthetic_graph.h"
#include <gtest/gtest.h>

#include "limen/project/graph/pose_graph.h"

namespace limen {
namespace {

/// Three scans that are sure of one another, and a fourth: a link puts it where it stands, another, nearly as
/// sure, two metres off.
struct OfTwoPlaces {
  SyntheticGraph made = synthetic_graph(3, 1, 2, 0.0, 8);
  Vector3d off{2.0, 0.0, 0.0};
  Rigid3 place;

  OfTwoPlaces() {
    RandomStream random(8, 1);
    place = random_pose(random, 5.0);
    made.graph.nodes = 4;
    add(0, {place.rotation, place.translation}, 2e-4, random);
    add(1, {place.rotation, place.translation + off}, 5e-3, random);
  }

  void add(int target, const Rigid3& world_from_fourth, double chance, RandomStream& random) {
    GraphLink link;
    link.source = 3;
    link.target = target;
    link.chance = chance;
    link.poses = {measured_pose(
        inverse(made.world_from_node[static_cast<std::size_t>(target)]) * world_from_fourth, 10.0, random)};
    made.graph.links.push_back(link);
  }

  /// Node 2 speaks against the fourth where it would stand `off`, and where it stands.
  [[nodiscard]] PoseHearing hearing(double against_other_m2, double against_present_m2) const {
    const auto surface = [=, this](int source, int target, const Rigid3& target_from_source) -> PoseHeard {
      if (source != 3 || target != 2) return {};
      const Rigid3 world = made.world_from_node[2] * target_from_source;
      const bool other = (world.translation - place.translation).norm() > 1.0;
      return {2.0, other ? against_other_m2 : against_present_m2};
    };
    return {surface, {}};
  }

  [[nodiscard]] SolvedNode solved(const PoseHearing& hearing) const {
    return solve_graph(made.graph, 0.001, hearing).nodes[3];
  }
};

TEST(RefutedPlaces, APlaceWhereOthersSawThroughIsNoQuestion) {
  const OfTwoPlaces scans;
  EXPECT_EQ(scans.solved({}).state, NodeState::ambiguous);
  EXPECT_FALSE(scans.solved({}).alternatives.empty());
  EXPECT_EQ(scans.solved(scans.hearing(5.0, 0.0)).state, NodeState::registered);
  EXPECT_TRUE(scans.solved(scans.hearing(5.0, 0.0)).alternatives.empty());
}

TEST(RefutedPlaces, WhatMayHaveBeenMovedRefutesNothing) {
  const OfTwoPlaces scans;
  EXPECT_EQ(scans.solved(scans.hearing(1.4, 0.0)).state, NodeState::ambiguous);
}

TEST(RefutedPlaces, WhatSpeaksAgainstBothPlacesSettlesNothing) {
  const OfTwoPlaces scans;
  EXPECT_EQ(scans.solved(scans.hearing(5.0, 5.0)).state, NodeState::ambiguous);
}

TEST(RefutedPlaces, WhichWayALinkLeadsDoesNotMatter) {
  for (const double against_m2 : {0.0, 1.0, 1.6, 1.8, 1.9, 2.0, 2.1, 2.2, 2.5, 4.0}) {
    OfTwoPlaces scans;
    GraphLink& present = scans.made.graph.links[scans.made.graph.links.size() - 2];
    present.chance = 1e-6;
    const SolvedNode forth = scans.solved(scans.hearing(0.0, against_m2));
    GraphLink& other = scans.made.graph.links.back();
    std::swap(other.source, other.target);
    for (LinkPose& pose : other.poses) pose = reversed(pose);
    const SolvedNode back = scans.solved(scans.hearing(0.0, against_m2));
    EXPECT_EQ(forth.state, back.state) << against_m2;
    EXPECT_EQ(forth.alternatives.size(), back.alternatives.size()) << against_m2;
  }
}

TEST(RefutedPlaces, OnlyWhatStandsFirmIsHeardAndTheLoudestOnce) {
  AcceptedPoses accepted;
  accepted.frame_from_node.resize(4);
  accepted.component = {0, 0, 0, 1};
  const Rigid3 movement{Matrix3d::Identity(), {3.0, 0.0, 0.0}};
  const PoseHearing hearing{[](int /*source*/, int target, const Rigid3& pose) -> PoseHeard {
                              return {0.0, pose.translation.norm() > 1.0 ? 3.0 + target : 0.0};
                            },
                            {}};
  const auto nats = [&](const std::vector<bool>& firm) {
    return nats_against_place(accepted, 0, movement, firm, hearing);
  };
  const double of_the_first = nats({true, true, false, false});
  EXPECT_GT(of_the_first, 20.0);
  EXPECT_DOUBLE_EQ(nats({false, false, false, false}), 0.0);
  EXPECT_DOUBLE_EQ(nats({false, false, false, true}), 0.0);  // of another component
  EXPECT_NEAR(nats({true, true, true, true}), of_the_first * 4.0 / 3.0, 1e-9);
}

}  // namespace
}  // namespace limen
