// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/configuration.h"

#include <algorithm>

#include "support/synthetic_graph.h"
#include <gtest/gtest.h>

#include "limen/project/graph/moves.h"

namespace limen {
namespace {

double error_of(const SyntheticGraph& made, const Configuration& found, std::size_t a, std::size_t b) {
  const Rigid3 truth = inverse(made.world_from_node[a]) * made.world_from_node[b];
  const Rigid3 placed = inverse(found.frame_from_node[a]) * found.frame_from_node[b];
  return (truth.translation - placed.translation).norm();
}

/// Links that are known less well and agree with one another, and one that is known best and wrong.
void expect_outweighed(SyntheticGraph made, const LinkPose& pose) {
  for (GraphLink& link : made.graph.links) {
    link.chance = 0.05;
    link.poses.front().probability = 0.9;
  }
  GraphLink wrong;
  wrong.source = 11;
  wrong.target = 0;
  wrong.chance = 1e-7;
  wrong.poses = {pose};
  made.graph.links.push_back(wrong);
  const Configuration found = best_configuration(made.graph, LinkMatcher(made.graph));
  EXPECT_EQ(found.pose.back(), -1);
  for (std::size_t n = 1; n < 12; ++n) EXPECT_LT(error_of(made, found, 0, n), 0.05) << n;
}

TEST(Configuration, LinksThatAgreeOutweighOneThatIsKnownBest) {
  RandomStream random(7, 3);
  expect_outweighed(synthetic_graph(4, 3, 5, 0.0, 7), measured_pose(random_pose(random, 15.0), 90.0, random));
}

/// The same within one place: no other place is a decimetre away.
TEST(Configuration, LinksThatAgreeOutweighOneThatIsADecimetreOff) {
  const SyntheticGraph made = synthetic_graph(4, 3, 5, 0.0, 7);
  RandomStream random(7, 3);
  Rigid3 off = inverse(made.world_from_node[0]) * made.world_from_node[11];
  off.translation.x() += 0.1;
  expect_outweighed(made, measured_pose(off, 15.0, random));
}

/// The configuration is a property of the pairs: numbers of links mean nothing.
TEST(Configuration, TheOrderOfLinksMeansNothing) {
  SyntheticGraph made = synthetic_graph(5, 3, 4, 0.25, 12);
  const Configuration forth = best_configuration(made.graph, LinkMatcher(made.graph));
  PoseGraph reversed = made.graph;
  std::reverse(reversed.links.begin(), reversed.links.end());
  const Configuration back = best_configuration(reversed, LinkMatcher(reversed));
  const std::size_t links = made.graph.links.size();
  for (std::size_t k = 0; k < links; ++k) EXPECT_EQ(forth.pose[k], back.pose[links - 1 - k]) << k;
  for (std::size_t n = 0; n < forth.frame_from_node.size(); ++n) {
    EXPECT_LT((forth.frame_from_node[n].translation - back.frame_from_node[n].translation).norm(), 1e-9) << n;
  }
}

/// A pair that shows two look-alike places contradicts laying one on the other, where they are more probable
/// than any building's other pairs can make them.
TEST(Configuration, APairOfLookAlikesKeepsPartsFromEachOther) {
  SyntheticGraph made = synthetic_graph(2, 1, 1, 0.0, 3);
  ASSERT_EQ(made.graph.links.size(), 1U);
  GraphLink& link = made.graph.links.front();
  link.chance = 0.01;
  link.poses.front().probability = 0.6;
  EXPECT_EQ(best_configuration(made.graph, LinkMatcher(made.graph)).component[1], 0);
  GraphLink look_alike = link;
  look_alike.look_alike = 0.9;
  made.graph.links.push_back(look_alike);
  EXPECT_EQ(best_configuration(made.graph, LinkMatcher(made.graph)).component[1], 0);
  look_alike.look_alike = 0.9999;
  made.graph.links.push_back(look_alike);
  EXPECT_EQ(best_configuration(made.graph, LinkMatcher(made.graph)).component[1], 1);
}

/// Scans of one room of a hotel laid on another room: what each link says for itself is tried as a move.
TEST(Moves, APoseThatIsNotTakenProposesAMove) {
  SyntheticGraph made = synthetic_graph(4, 1, 3, 0.0, 5);
  RandomStream random(5, 3);
  GraphLink other = made.graph.links.back();
  other.poses = {measured_pose(random_pose(random, 9.0), 10.0, random)};
  made.graph.links.push_back(other);
  const LinkMatcher matcher(made.graph);
  const Configuration found = best_configuration(made.graph, matcher);
  const std::vector<Move> moves = proposed_moves(made.graph, matcher, found);
  ASSERT_FALSE(moves.empty());
  for (const Move& move : moves) {
    EXPECT_LT(move.gain(), 0.0);
    EXPECT_EQ(move.moved, std::vector<int>{static_cast<int>(made.graph.links.size()) - 1});
  }
}

}  // namespace
}  // namespace limen
