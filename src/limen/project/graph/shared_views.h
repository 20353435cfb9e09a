// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/project/graph/pose_graph.h"

namespace limen {

/// What two nodes say of the pose that the solution gives them, where no accepted link holds the two. The
/// source stands less surely: what they say is of its place.
struct HeardPair {
  GraphLink pair;            ///< that pose, and what speaks there against twins
  double chance_nats = 0.0;  ///< by how much surface speaks against chance
};

/// A solution to be put to the test.
struct AcceptedPoses {
  std::vector<Rigid3> frame_from_node;
  std::vector<int> component;  ///< of each node, -1: none
  std::vector<int> pose;       ///< of each link: the accepted one, -1: none
  std::vector<HeardPair> heard = {};
  /// Of each node, where any was asked: by how much passes that see it beyond the links that hold it speak
  /// against chance.
  std::vector<double> beyond_nats = {};
};

/// A pair and what it says, natural logarithms: for something, or against it (less than 0).
struct SaidByPair {
  const GraphLink* pair = nullptr;
  double nats = 0.0;
};

/// Whether the solution lays the two as the pair's best pose does.
[[nodiscard]] bool is_laid_so(const GraphLink& pair, const AcceptedPoses& accepted);

/// Which links are one witness: their ends see the same surface on either side. For one thread at a time.
class SharedViews {
 public:
  SharedViews(const PoseGraph& graph, const AcceptedPoses& accepted);

  /// Of `links` the first of each view; `moved` tells for every node on which side of a cut it lies, and
  /// every link crosses the cut.
  [[nodiscard]] std::vector<int> independent(const std::vector<int>& links,
                                             const std::vector<bool>& moved) const;

  /// How much of what a pair shows others that cross the same cut have shown already, in [0, 1].
  [[nodiscard]] double seen_already(const GraphLink& pair, const std::vector<const GraphLink*>& others,
                                    const std::vector<bool>& moved) const;

  /// Of each pair, all across one cut, the share of what it says that none before it which says likewise (for
  /// or against) has said.
  [[nodiscard]] std::vector<double> fresh_shares(const std::vector<SaidByPair>& said,
                                                 const std::vector<bool>& moved) const;

  /// How many accepted links see what an accepted link sees, itself included.
  [[nodiscard]] int witnesses_like(int link) const;

 private:
  /// What an accepted link joins to a node.
  struct Neighbour {
    int node = -1;
    double shared_m2 = 0.0;
  };
  static bool by_node(const Neighbour& a, const Neighbour& b);
  /// Null: no link joins the two.
  [[nodiscard]] const Neighbour* neighbour(int a, int b) const;
  [[nodiscard]] double shared(int a, int b) const;
  /// Whether of `surface_m2` that a link shows both nodes see most.
  [[nodiscard]] bool same_view(int a, int b, double surface_m2) const;
  [[nodiscard]] std::vector<int> like(int node, double surface_m2) const;

  const PoseGraph& graph_;
  std::vector<std::vector<Neighbour>> neighbours_;  ///< of each node, by number
  // Of each node, while a pair is asked: the share of its surface that the node sees with either end; else 0.
  mutable std::vector<double> with_first_;
  mutable std::vector<double> with_second_;
};

}  // namespace limen
