// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "support/synthetic_graph.h"
#include <gtest/gtest.h>

#include "limen/base/angles.h"
#include "limen/project/graph/pose_graph.h"
#include "limen/register/judge/look_alike_odds.h"

namespace limen {
namespace {

/// What things say of the last pose of a link; `otherwise`: odds beforehand.
void ask_look_alike(double otherwise, double otherwise_nats, double alike_nats, GraphLink& link) {
  LookAlikeEvidence look_alike;
  look_alike.otherwise = otherwise;
  look_alike.alike = 0.0053;
  look_alike.otherwise_nats.fill(otherwise_nats);
  look_alike.alike_nats.fill(alike_nats);
  link.poses.back().look_alike = look_alike;
  link.look_alike = probability_of(*link.poses.front().look_alike);
}

bool taken(const SolvedLink& link) {
  return link.pose >= 0;
}

/// Poses of two nodes to one another, against the truth: metres at the source's place.
double error_of(const SyntheticGraph& made, const SolvedGraph& solved, std::size_t a, std::size_t b) {
  const Rigid3 truth = inverse(made.world_from_node[a]) * made.world_from_node[b];
  const Rigid3 found = inverse(solved.nodes[a].frame_from_node) * solved.nodes[b].frame_from_node;
  return (truth.translation - found.translation).norm();
}

TEST(SolveGraph, TrueLinksAreAllKeptAndCheckedByLoops) {
  const SyntheticGraph made = synthetic_graph(6, 5, 5, 0.0, 3);
  const SolvedGraph solved = solve_graph(made.graph);
  EXPECT_EQ(solved.components, 1);
  std::size_t verified = 0;
  for (const SolvedLink& link : solved.links) verified += link.state == LinkState::verified ? 1 : 0;
  EXPECT_GE(verified + 1, solved.links.size());
  for (std::size_t n = 1; n < solved.nodes.size(); ++n) {
    EXPECT_EQ(solved.nodes[n].state, NodeState::registered);
    EXPECT_LT(error_of(made, solved, 0, n), 0.05);
  }
}

TEST(SolveGraph, FalseLinksAreFoundByTheirLoops) {
  std::size_t kept = 0;
  std::size_t all_true = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const SyntheticGraph made = synthetic_graph(6, 5, 6, 0.3, seed);
    const SolvedGraph solved = solve_graph(made.graph);
    for (std::size_t k = 0; k < made.graph.links.size(); ++k) {
      if (made.is_false[k]) {
        EXPECT_NE(solved.links[k].state, LinkState::verified) << "seed " << seed << " link " << k;
      } else {
        ++all_true;
        kept += taken(solved.links[k]) ? 1 : 0;
      }
    }
    for (std::size_t n = 1; n < solved.nodes.size(); ++n) {
      if (solved.nodes[n].state != NodeState::registered || solved.nodes[0].state != NodeState::registered)
        continue;
      if (solved.nodes[n].component == solved.nodes[0].component) {
        EXPECT_LT(error_of(made, solved, 0, n), 0.08) << "seed " << seed << " node " << n;
      }
    }
  }
  EXPECT_GE(static_cast<double>(kept), 0.99 * static_cast<double>(all_true));
}

/// Of two scans neither lies more surely in one frame with the other than the other with it.
TEST(SolveGraph, WhatLendsTheFrameIsNoSurerThanTheSurestOfTheOthers) {
  for (const auto& [chance, state] :
       {std::pair(1e-6, NodeState::registered), std::pair(0.02, NodeState::probable),
        std::pair(0.3, NodeState::ambiguous)}) {
    PoseGraph graph;
    graph.nodes = 2;
    GraphLink link;
    link.source = 1;
    link.target = 0;
    link.chance = chance;
    link.poses.emplace_back();
    link.poses.front().probability = 1.0 - chance;
    link.poses.front().covariance *= 1e-6;
    graph.links.push_back(link);
    const SolvedGraph solved = solve_graph(graph);
    EXPECT_EQ(solved.nodes[0].state, state) << chance;
    EXPECT_EQ(solved.nodes[1].state, state) << chance;
    EXPECT_DOUBLE_EQ(solved.nodes[0].doubt, solved.nodes[1].doubt);
  }
}

/// A fourth node by one link that leaves it loose along x.
SyntheticGraph with_a_loose_node() {
  SyntheticGraph made = synthetic_graph(3, 1, 2, 0.0, 5);
  made.graph.nodes = 4;
  GraphLink link;
  link.source = 3;
  link.target = 0;
  link.chance = 1e-6;
  LinkPose pose;
  pose.target_from_source.translation = {3.0, 2.0, 0.0};
  pose.centre = pose.target_from_source.translation;
  pose.covariance = 1e-6 * Matrix6d::Identity();
  pose.covariance(3, 3) = 0.1 * 0.1;
  link.poses.push_back(pose);
  made.graph.links.push_back(link);
  return made;
}

TEST(SolveGraph, APoseMeasuredInPlaceHoldsALooseNodeAndSaysNothingOfItsPlace) {
  SyntheticGraph made = with_a_loose_node();
  const SolvedGraph before = solve_graph(made.graph);
  EXPECT_EQ(before.nodes[3].state, NodeState::under_constrained);
  LinkPose pose = made.graph.links.back().poses.front();
  pose.target_from_source.translation.x() += 0.03;
  pose.covariance = 1e-4 * Matrix6d::Identity();
  made.graph.measured_in_place.push_back({3, 0, pose});
  const SolvedGraph solved = solve_graph(made.graph);
  EXPECT_EQ(solved.in_place, std::vector<bool>{true});
  EXPECT_EQ(solved.nodes[3].state, NodeState::registered);
  EXPECT_DOUBLE_EQ(solved.nodes[3].doubt, before.nodes[3].doubt);
  const Rigid3 found = inverse(solved.nodes[0].frame_from_node) * solved.nodes[3].frame_from_node;
  EXPECT_NEAR(found.translation.x(), 3.03, 0.002);
  // It is of another place, or of nodes that nothing else joins.
  made.graph.measured_in_place.front().pose.target_from_source.translation.x() += 5.0;
  EXPECT_EQ(solve_graph(made.graph).nodes[3].state, NodeState::under_constrained);
  made.graph.links.pop_back();
  EXPECT_EQ(solve_graph(made.graph).nodes[3].state, NodeState::floating);
}

TEST(SolveGraph, ALinkInNoLoopIsABridge) {
  SyntheticGraph made = synthetic_graph(3, 1, 2, 0.0, 5);
  // A fourth node by one link.
  RandomStream random(5, 1);
  made.graph.nodes = 4;
  GraphLink link;
  link.source = 3;
  link.target = 0;
  link.poses = {measured_pose(random_pose(random, 5.0), 10.0, random)};
  made.graph.links.push_back(link);
  const SolvedGraph solved = solve_graph(made.graph);
  EXPECT_EQ(solved.links.back().state, LinkState::bridge);
  EXPECT_NEAR(solved.links.back().redundancy, 0.0, 1e-6);
  EXPECT_EQ(solved.links.front().state, LinkState::verified);
}

/// Two groups of scans that a pass joins, which is off by decimetres where it sees each; what one scan of
/// either sees of the other fits only once the pass gives way.
TEST(SolveGraph, AnExactLinkThatComesLateIsTakenAndLooseOnesGiveWay) {
  RandomStream random(12, 1);
  PoseGraph graph;
  graph.nodes = 7;
  std::vector<Rigid3> world_from_node{Rigid3{}};
  for (int n = 1; n < 7; ++n) world_from_node.push_back(random_pose(random, n < 4 ? 3.0 : 6.0));
  const auto add = [&](int source, int target, double sigma_m, const Vector3d& off, double chance) {
    GraphLink link;
    link.source = source;
    link.target = target;
    link.chance = chance;
    const Rigid3 truth = inverse(world_from_node[static_cast<std::size_t>(target)]) *
                         world_from_node[static_cast<std::size_t>(source)];
    LinkPose pose = measured_pose(truth, 20.0, random);
    pose.target_from_source.translation += off;
    pose.covariance.diagonal().tail<3>().array() += sigma_m * sigma_m;
    pose.probability = 1.0 - chance;
    link.poses = {pose};
    graph.links.push_back(link);
  };
  for (const int first : {1, 4}) {
    add(first + 1, first, 0.0, Vector3d::Zero(), 1e-6);
    add(first + 2, first, 0.0, Vector3d::Zero(), 1e-6);
    add(first + 2, first + 1, 0.0, Vector3d::Zero(), 1e-6);
    for (int n = first; n < first + 3; ++n)
      add(n, 0, 0.05, Vector3d(first == 1 ? 0.07 : -0.07, 0.0, 0.0), 1e-6);
  }
  add(6, 3, 0.0, Vector3d::Zero(), 0.2);
  const SolvedGraph solved = solve_graph(graph);
  EXPECT_EQ(solved.links.back().pose, 0);
  for (std::size_t k = 0; k < solved.links.size(); ++k) EXPECT_TRUE(taken(solved.links[k])) << k;
  for (const SolvedNode& node : solved.nodes) EXPECT_EQ(node.state, NodeState::registered);
  const Rigid3 found = inverse(solved.nodes[3].frame_from_node) * solved.nodes[6].frame_from_node;
  const Rigid3 truth = inverse(world_from_node[3]) * world_from_node[6];
  EXPECT_LT((found.translation - truth.translation).norm(), 0.03);
}

/// Seven scans; links among them are sure, or open: then they have two ways.
class SevenScans {
 public:
  SevenScans() {
    graph.nodes = 7;
    for (int n = 0; n < 7; ++n) world_from_node_.push_back(random_pose(random_, 5.0));
  }
  void add(int source, int target, bool open) {
    GraphLink link;
    link.source = source;
    link.target = target;
    link.chance = link.look_alike = 1e-6;
    const Rigid3 truth = inverse(world_from_node_[static_cast<std::size_t>(target)]) *
                         world_from_node_[static_cast<std::size_t>(source)];
    link.poses = {measured_pose(truth, 20.0, random_)};
    if (open) {
      link.chance = 0.02;
      link.poses.push_back(measured_pose(random_pose(random_, 5.0), 20.0, random_));
    }
    for (LinkPose& pose : link.poses) pose.probability = (1.0 - link.chance) / (open ? 2.0 : 1.0);
    graph.links.push_back(link);
  }

  PoseGraph graph;

 private:
  RandomStream random_{15, 1};
  std::vector<Rigid3> world_from_node_;
};

/// Three scans that sure links hold together, and four others that open links join to them: the three lend
/// the frame, and are registered, though they are the smaller side of the join.
TEST(SolveGraph, WhatSureLinksHoldTogetherLendsTheFrame) {
  SevenScans scans;
  for (int n = 1; n < 5; ++n) scans.add(n, n - 1, true);
  scans.add(5, 4, false);
  scans.add(6, 4, false);
  scans.add(6, 5, false);
  const SolvedGraph solved = solve_graph(scans.graph);
  ASSERT_EQ(solved.components, 1);
  for (std::size_t n = 0; n < 7; ++n)
    EXPECT_EQ(solved.nodes[n].state, n < 4 ? NodeState::ambiguous : NodeState::registered) << n;
}

/// Nothing joins the three to the four: theirs is the first component, though it is the smaller one.
TEST(SolveGraph, TheComponentWithMostPlacedScansIsTheFirst) {
  SevenScans scans;
  for (int n = 1; n < 4; ++n) scans.add(n, n - 1, true);
  scans.add(5, 4, false);
  scans.add(6, 4, false);
  scans.add(6, 5, false);
  const SolvedGraph solved = solve_graph(scans.graph);
  ASSERT_EQ(solved.components, 2);
  for (std::size_t n = 0; n < 7; ++n) EXPECT_EQ(solved.nodes[n].component, n < 4 ? 1 : 0) << n;
}

/// Two groups that hold together in themselves, and a link that joins them but leaves a decimetre open: the
/// larger one lends the frame, whichever comes first.
TEST(SolveGraph, TheLargerPartThatIsHeldLendsTheFrame) {
  RandomStream random(17, 1);
  PoseGraph graph;
  graph.nodes = 7;
  std::vector<Rigid3> world_from_node;
  for (int n = 0; n < 7; ++n) world_from_node.push_back(random_pose(random, 5.0));
  const auto add = [&](int source, int target) -> GraphLink& {
    GraphLink link;
    link.source = source;
    link.target = target;
    link.chance = 1e-9;
    const Rigid3 truth = inverse(world_from_node[static_cast<std::size_t>(target)]) *
                         world_from_node[static_cast<std::size_t>(source)];
    link.poses = {measured_pose(truth, 20.0, random)};
    graph.links.push_back(link);
    return graph.links.back();
  };
  for (const std::vector<int>& group : {std::vector<int>{0, 1, 2}, std::vector<int>{3, 4, 5, 6}}) {
    for (std::size_t a = 0; a < group.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) add(group[a], group[b]);
    }
  }
  add(3, 2).poses.front().covariance(3, 3) += 0.1 * 0.1;
  const SolvedGraph solved = solve_graph(graph);
  ASSERT_EQ(solved.components, 1);
  for (std::size_t n = 0; n < 7; ++n)
    EXPECT_EQ(solved.nodes[n].state, n < 3 ? NodeState::under_constrained : NodeState::registered) << n;
}

TEST(SolveGraph, AnOpenLinkIsSettledByItsLoop) {
  SyntheticGraph made = synthetic_graph(3, 1, 2, 0.0, 8);
  ASSERT_EQ(made.graph.links.size(), 3U);
  RandomStream random(8, 1);
  GraphLink& link = made.graph.links.back();
  link.poses.insert(link.poses.begin(), measured_pose(random_pose(random, 5.0), 12.0, random));
  const SolvedGraph solved = solve_graph(made.graph);
  EXPECT_EQ(solved.links.back().pose, 1);
  for (const SolvedNode& node : solved.nodes) EXPECT_EQ(node.state, NodeState::registered);
}

TEST(SolveGraph, AnOpenLinkThatNothingSettlesLeavesItsScanAmbiguous) {
  SyntheticGraph made = synthetic_graph(3, 1, 2, 0.0, 9);
  RandomStream random(9, 1);
  made.graph.nodes = 4;
  GraphLink link;
  link.source = 3;
  link.target = 1;
  link.poses = {measured_pose(random_pose(random, 5.0), 10.0, random),
                measured_pose(random_pose(random, 5.0), 10.0, random)};
  made.graph.links.push_back(link);
  const SolvedGraph solved = solve_graph(made.graph);
  EXPECT_EQ(solved.nodes[3].state, NodeState::ambiguous);
  EXPECT_FALSE(solved.nodes[3].alternatives.empty());
  EXPECT_EQ(solved.nodes[1].state, NodeState::registered);
  EXPECT_FALSE(solved.questions.empty());
}

/// A room that is alike to one next door: three scans there say that it may be theirs, and close loops with
/// one another; what two passes see through its windows leaves hardly a doubt.
TEST(SolveGraph, ARoomGoesWhereItsWindowsSayNotOnItsLookAlike) {
  RandomStream random(11, 1);
  PoseGraph graph;
  graph.nodes = 6;
  std::vector<Rigid3> world_from_node;
  for (int n = 0; n < graph.nodes; ++n) world_from_node.push_back(random_pose(random, 6.0));
  const Rigid3 look_alike_from_room = random_pose(random, 6.0);
  const auto link = [&](int source, int target, const Rigid3& moved) -> GraphLink& {
    GraphLink made;
    made.source = source;
    made.target = target;
    made.poses = {measured_pose(inverse(world_from_node[static_cast<std::size_t>(target)]) * moved *
                                    world_from_node[static_cast<std::size_t>(source)],
                                20.0, random)};
    graph.links.push_back(made);
    return graph.links.back();
  };
  link(1, 0, {}).poses[0].agreeing_m2 = 600.0;
  for (const int neighbour : {2, 3, 4}) link(neighbour, 0, {});
  link(3, 2, {});
  link(4, 3, {});
  for (const int neighbour : {2, 3, 4}) {
    GraphLink& likely = link(5, neighbour, look_alike_from_room);
    likely.look_alike = 0.3;
  }
  GraphLink& open = link(5, 1, {});
  open.chance = 1e-4;
  open.poses.push_back(measured_pose(random_pose(random, 6.0), 12.0, random));
  open.poses[0].probability = 0.998;
  open.poses[1].probability = 0.0019;
  const SolvedGraph solved = solve_graph(graph);
  const Rigid3 truth = inverse(world_from_node[0]) * world_from_node[5];
  const Rigid3 found = inverse(solved.nodes[0].frame_from_node) * solved.nodes[5].frame_from_node;
  EXPECT_EQ(solved.nodes[5].component, solved.nodes[0].component);
  EXPECT_LT((truth.translation - found.translation).norm(), 0.05);
}

/// A building that looks alike from either end, and two groups of scans that only its model joins: each group
/// fits at either end, so that where one is from the other is not known, though each is sure of itself.
TEST(SolveGraph, GroupsThatASymmetricModelJoinsAreNotRegisteredTogether) {
  RandomStream random(31, 1);
  const Rigid3 other_end{Eigen::AngleAxisd(radians(180.0), Vector3d::UnitZ()).toRotationMatrix(),
                         Vector3d(14.0, 9.0, 0.0)};
  PoseGraph graph;
  graph.nodes = 5;  // the model, two scans, and two scans
  std::vector<Rigid3> model_from_scan(1);
  for (int n = 1; n < graph.nodes; ++n) model_from_scan.push_back(random_pose(random, 6.0));
  const auto add = [&](int source, int target, const Rigid3& truth) -> GraphLink& {
    GraphLink link;
    link.source = source;
    link.target = target;
    link.chance = 1e-6;
    link.poses = {measured_pose(truth, 30.0, random)};
    graph.links.push_back(link);
    return graph.links.back();
  };
  for (int n = 1; n < graph.nodes; ++n) {
    const Rigid3& truth = model_from_scan[static_cast<std::size_t>(n)];
    GraphLink& link = add(n, 0, truth);
    link.poses.push_back(measured_pose(other_end * truth, 30.0, random));
    link.poses[0].probability = 0.53;
    link.poses[1].probability = 0.47;
  }
  // Less sure than the links to the model: a scan by itself hangs on less than its group.
  add(2, 1, inverse(model_from_scan[1]) * model_from_scan[2]).chance = 1e-3;
  add(4, 3, inverse(model_from_scan[3]) * model_from_scan[4]).chance = 1e-3;
  const SolvedGraph solved = solve_graph(graph);
  const auto registered = [&](std::size_t n) { return solved.nodes[n].state == NodeState::registered; };
  EXPECT_TRUE(registered(1) == registered(2) && registered(3) == registered(4));
  EXPECT_NE(registered(1), registered(3));
  EXPECT_FALSE(solved.questions.empty());
}

/// Passes that drift are known to one another to centimetres: a second pose that lies within that is the
/// same place.
TEST(SolveGraph, APoseWithinWhatIsKnownOfItsLinkIsNoOtherPlace) {
  SyntheticGraph made = synthetic_graph(3, 1, 2, 0.0, 9);
  RandomStream random(9, 1);
  made.graph.nodes = 4;
  const LinkPose best = measured_pose(random_pose(random, 5.0), 10.0, random);
  for (const double loose : {1.0, 2000.0}) {
    GraphLink link;
    link.source = 3;
    link.target = 1;
    link.poses = {best, best};
    link.poses[1].target_from_source.translation += Vector3d(0.3, 0.0, 0.0);
    for (LinkPose& pose : link.poses) pose.covariance *= loose;
    PoseGraph graph = made.graph;
    graph.links.push_back(link);
    EXPECT_EQ(solve_graph(graph).questions.empty(), loose > 1.0) << loose;
  }
}

/// Two passes that drift, and a station by each: that one link of a pass misses by some deviations is no
/// other place for half of the building, though links of passes bear either.
TEST(SolveGraph, ALinkThatMissesByAFewDeviationsIsNoOtherPlace) {
  RandomStream random(21, 1);
  PoseGraph graph;
  graph.nodes = 4;  // two passes, two stations
  std::vector<Rigid3> world_from_node;
  for (int n = 0; n < 4; ++n) world_from_node.push_back(random_pose(random, 5.0));
  const auto add = [&](int source, int target, double sigma_m, double off_m, double wrong) {
    GraphLink link;
    link.source = source;
    link.target = target;
    link.chance = wrong;
    const Rigid3 truth = inverse(world_from_node[static_cast<std::size_t>(target)]) *
                         world_from_node[static_cast<std::size_t>(source)];
    LinkPose pose = measured_pose(truth, 20.0, random);
    pose.target_from_source.translation.z() += off_m;
    pose.covariance.diagonal().tail<3>().array() += sigma_m * sigma_m;
    pose.probability = 1.0 - wrong;
    link.poses = {pose};
    graph.links.push_back(link);
  };
  constexpr double kSigma = 0.012;
  add(1, 0, kSigma, 0.0, 1e-9);
  add(2, 0, kSigma, 0.0, 1e-9);
  add(3, 1, kSigma, 0.0, 1e-9);
  add(3, 0, kSigma, 0.0, 1e-9);
  add(3, 2, 0.0, 0.0, 0.05);
  const PoseGraph without = graph;
  for (const double off_m : {0.08, 0.25}) {
    graph = without;
    add(2, 1, kSigma, off_m, 1e-9);
    const SolvedGraph solved = solve_graph(graph);
    EXPECT_FALSE(taken(solved.links.back())) << off_m;
    EXPECT_EQ(solved.questions.empty(), off_m < 0.1) << off_m;
  }
}

/// Each of many links to a pass may leave a decimetre open, all together do not.
TEST(SolveGraph, WhatNoSingleLinkForbidsAllForbidTogether) {
  for (const int stations : {1, 8}) {
    PoseGraph graph;
    graph.nodes = stations + 1;
    RandomStream random(3, 1);
    std::vector<Rigid3> truth(static_cast<std::size_t>(graph.nodes));
    for (int k = 0; k < stations; ++k) truth[static_cast<std::size_t>(k)] = random_pose(random, 8.0);
    const auto between = [&](int source, int target) {
      return inverse(truth[static_cast<std::size_t>(target)]) * truth[static_cast<std::size_t>(source)];
    };
    const auto add = [&](int source, int target, double loose) -> GraphLink& {
      GraphLink link;
      link.source = source;
      link.target = target;
      link.poses = {measured_pose(between(source, target), 20.0, random)};
      link.poses.front().covariance *= loose;
      graph.links.push_back(link);
      return graph.links.back();
    };
    for (int k = 1; k < stations; ++k) add(k, k - 1, 1.0);
    for (int k = 0; k < stations; ++k) add(stations, k, 25.0);
    GraphLink& open = graph.links.back();
    LinkPose slipped = open.poses.front();
    slipped.target_from_source.translation += Vector3d(0.25, 0.0, 0.0);
    slipped.covariance /= 25.0;
    open.poses.push_back(slipped);
    EXPECT_EQ(solve_graph(graph).questions.empty(), stations > 1) << stations;
  }
}

/// Two rooms alike, scanned three times each, and a corridor that sees both: each pair of scans of different
/// rooms is taken for one room, and all these false links agree with one another.
TEST(SolveGraph, LookAlikeRoomsLinkedWronglyAreNeverRegisteredBoth) {
  RandomStream random(4, 1);
  PoseGraph graph;
  graph.nodes = 7;
  std::vector<Rigid3> truth(7);
  const Vector3d look_alike(6.8, 0, 0);
  for (std::size_t k = 0; k < 3; ++k) {
    truth[k].translation = {static_cast<double>(k), 1.0, 0};
    truth[k + 3].translation = truth[k].translation + look_alike;
  }
  truth[6].translation = {3, -3, 0};
  const auto add = [&](int source, int target, bool as_one_room, double agreeing) {
    Rigid3 from = truth[static_cast<std::size_t>(source)];
    if (as_one_room && source >= 3) from.translation -= look_alike;
    GraphLink link;
    link.source = source;
    link.target = target;
    link.poses = {measured_pose(inverse(truth[static_cast<std::size_t>(target)]) * from, agreeing, random)};
    graph.links.push_back(link);
  };
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < a; ++b) {
      add(a, b, false, 40.0);
      add(a + 3, b + 3, false, 40.0);
    }
    for (int b = 0; b < 3; ++b) add(a + 3, b, true, 38.0);
    add(6, a, false, 6.0);
    add(6, a + 3, false, 6.0);
  }
  const SolvedGraph solved = solve_graph(graph);
  EXPECT_FALSE(solved.questions.empty());
  for (std::size_t a = 0; a < 7; ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      if (solved.nodes[a].state != NodeState::registered || solved.nodes[b].state != NodeState::registered)
        continue;
      const Rigid3 found = inverse(solved.nodes[b].frame_from_node) * solved.nodes[a].frame_from_node;
      const Rigid3 right = inverse(truth[b]) * truth[a];
      EXPECT_LT((found.translation - right.translation).norm(), 0.05) << a << " and " << b;
    }
  }
}

constexpr int kRooms = 4;
constexpr int kCorridor = 2 * kRooms;

struct TwoStoreys {
  PoseGraph graph;
  std::vector<Rigid3> world_from_node;
};

/// A corridor that was laid on that of the storey above, by what is furnished alike around both: links to its
/// own storey, as sure as these, say otherwise. So do many links elsewhere that take one storey for the
/// other, and that would move a whole storey at once.
TwoStoreys two_storeys(bool corridor_is_source = true) {
  RandomStream random(9, 1);
  TwoStoreys made;
  PoseGraph& graph = made.graph;
  graph.nodes = kCorridor + 1;
  const Vector3d storey(0, 0, 3.2);
  std::vector<Rigid3>& truth = made.world_from_node;
  truth.resize(static_cast<std::size_t>(graph.nodes));
  for (int k = 0; k < kRooms; ++k) {
    truth[static_cast<std::size_t>(k)].translation = {4.0 * k, 0, 0};
    truth[static_cast<std::size_t>(kRooms + k)].translation = Vector3d(4.0 * k, 0, 0) + storey;
  }
  truth.back().translation = {6, 3, 0};
  // `up`: how many storeys too high the link takes its source to be.
  const auto add = [&](int source, int target, double up, double otherwise_nats, double alike_nats) {
    Rigid3 from = truth[static_cast<std::size_t>(source)];
    from.translation += up * storey;
    GraphLink link;
    link.source = source;
    link.target = target;
    link.poses = {measured_pose(inverse(truth[static_cast<std::size_t>(target)]) * from, 40.0, random)};
    ask_look_alike(0.171, otherwise_nats, alike_nats, link);
    graph.links.push_back(link);
  };
  for (int a = 0; a < kRooms; ++a) {
    for (int b = 0; b < a; ++b) {
      add(a, b, 0.0, 14.0, 14.0);
      add(kRooms + a, kRooms + b, 0.0, 14.0, 14.0);
    }
    // A staircase joins the storeys; rooms above one another are taken for one.
    add(kRooms + a, a, a == 0 ? 0.0 : -1.0, a == 0 ? 14.0 : 3.0, a == 0 ? 14.0 : 0.0);
  }
  const auto add_corridor = [&](int room, double up, double otherwise_nats, double alike_nats) {
    if (corridor_is_source)
      add(kCorridor, room, up, otherwise_nats, alike_nats);
    else
      add(room, kCorridor, -up, otherwise_nats, alike_nats);
  };
  for (int a = 1; a < kRooms; ++a) add_corridor(kRooms + a, 1.0, 7.0, 1.0);
  add_corridor(1, 0.0, 9.0, 0.0);
  add_corridor(2, 0.0, 9.0, 0.5);
  return made;
}

/// Two houses that look alike, each seen from two places. Three links lay them on one another, and say
/// together that they are two. Another link's second pose lays them there as well, but for some centimetres.
TEST(SolveGraph, ASideThatLeftDoesNotComeBackByAPoseBesideItsOwn) {
  RandomStream random(7, 1);
  PoseGraph graph;
  graph.nodes = 4;
  const Vector3d places[] = {{0, 0, 0}, {3, 0, 0}, {1, 2, 0}, {2, 3, 0}};
  const auto add_pose = [&](const Vector3d& off, double nats, GraphLink& link) {
    Rigid3 from;
    from.translation = places[link.source] + off - places[link.target];
    link.poses.push_back(measured_pose(from, 40.0, random));
    ask_look_alike(1.4, nats, nats, link);
  };
  const auto link_of = [](int source, int target, double chance) {
    GraphLink link;
    link.source = source;
    link.target = target;
    link.chance = chance;
    return link;
  };
  const auto add = [&](int source, int target, double chance, double nats) {
    graph.links.push_back(link_of(source, target, chance));
    add_pose(Vector3d::Zero(), nats, graph.links.back());
  };
  add(1, 0, 1e-5, 14.0);
  add(3, 2, 1e-5, 14.0);
  add(2, 0, 1e-4, 4.7);
  add(2, 1, 1e-4, 4.7);
  add(3, 1, 1e-4, -9.0);
  graph.links.push_back(link_of(3, 0, 0.01));
  add_pose({9, 9, 0}, -3.0, graph.links.back());
  add_pose({0.1, 0.06, 0}, 0.6, graph.links.back());
  graph.links.back().poses[0].probability = 0.5;
  graph.links.back().poses[1].probability = 0.49;
  const SolvedGraph solved = solve_graph(graph);
  const Rigid3 found = inverse(solved.nodes[0].frame_from_node) * solved.nodes[3].frame_from_node;
  EXPECT_FALSE(solved.nodes[0].component == solved.nodes[3].component &&
               (found.translation - places[3]).norm() < 1.0)
      << to_string(solved.nodes[3].state) << ", doubt " << solved.nodes[3].doubt;
}

TEST(SolveGraph, ARoomBetweenTwoStoreysIsAskedByItself) {
  const std::vector<Rigid3> truth = two_storeys().world_from_node;
  const SolvedGraph solved = solve_graph(two_storeys().graph);
  const Rigid3 right = inverse(truth.front()) * truth.back();
  const Rigid3 found = inverse(solved.nodes.front().frame_from_node) * solved.nodes.back().frame_from_node;
  EXPECT_TRUE(solved.nodes.back().state != NodeState::registered ||
              (found.translation - right.translation).norm() < 0.05)
      << to_string(solved.nodes.back().state) << ", doubt " << solved.nodes.back().doubt;
  // Rooms above one another look alike: the links that take them for one leave a little doubt.
  for (int n = 0; n < kCorridor; ++n) EXPECT_LT(solved.nodes[static_cast<std::size_t>(n)].doubt, 0.2) << n;
}

/// What is asked of a building is asked of it beside another one as well, that no link joins to it, and of
/// nothing else.
void expect_same_beside_another(const PoseGraph& alone) {
  const SyntheticGraph other = synthetic_graph(3, 1, 2, 0.0, 4);
  const int first = other.graph.nodes + 1;    // and a scan that nothing holds
  ASSERT_LT(other.graph.nodes, alone.nodes);  // the larger one is the first component
  PoseGraph both = other.graph;
  both.nodes = first + alone.nodes;
  for (GraphLink link : alone.links) {
    link.source += first;
    link.target += first;
    both.links.push_back(link);
  }
  const SolvedGraph solved = solve_graph(alone);
  const SolvedGraph beside = solve_graph(both);
  ASSERT_FALSE(solved.questions.empty());
  ASSERT_EQ(beside.questions.size(), solved.questions.size());
  for (std::size_t q = 0; q < solved.questions.size(); ++q) {
    std::vector<int> moved = solved.questions[q].moved;
    for (int& node : moved) node += first;
    EXPECT_EQ(beside.questions[q].moved, moved) << q;
  }
  for (std::size_t n = 0; n < solved.nodes.size(); ++n) {
    const SolvedNode& there = beside.nodes[n + static_cast<std::size_t>(first)];
    EXPECT_EQ(there.state, solved.nodes[n].state) << n;
    EXPECT_EQ(there.alternatives.size(), solved.nodes[n].alternatives.size()) << n;
  }
  for (std::size_t n = 0; n < static_cast<std::size_t>(first); ++n)
    EXPECT_TRUE(beside.nodes[n].alternatives.empty()) << n;
}

TEST(SolveGraph, ABuildingThatNothingJoinsChangesNothing) {
  expect_same_beside_another(two_storeys().graph);
  expect_same_beside_another(two_storeys(false).graph);
  // A scan that an open link holds, which has it as its target.
  SyntheticGraph made = synthetic_graph(4, 1, 3, 0.0, 6);
  RandomStream random(6, 1);
  GraphLink link;
  link.source = 0;
  link.target = made.graph.nodes++;
  for (int k = 0; k < 2; ++k) link.poses.push_back(measured_pose(random_pose(random, 5.0), 10.0, random));
  made.graph.links.push_back(link);
  expect_same_beside_another(made.graph);
}

TEST(SolveGraph, TheSameGraphGivesTheSameBits) {
  const SyntheticGraph made = synthetic_graph(5, 4, 5, 0.2, 2);
  const SolvedGraph a = solve_graph(made.graph);
  const SolvedGraph b = solve_graph(made.graph);
  for (std::size_t n = 0; n < a.nodes.size(); ++n)
    EXPECT_EQ(to_matrix(a.nodes[n].frame_from_node), to_matrix(b.nodes[n].frame_from_node));
}

}  // namespace
}  // namespace limen
