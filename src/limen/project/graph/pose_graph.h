// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "limen/model/look_alike_evidence.h"
#include "limen/project/graph/link_pose.h"
#include "limen/project/graph/pose_adjustment.h"
#include "limen/project/graph/pose_query.h"

namespace limen {

/// What is known of how a link's pose came about.
enum class LinkTrust {
  given,     ///< the files say so
  measured,  ///< by registering the pair: how sure it is its probabilities say
  weak       ///< the pose leaves a direction free, so that it does not distinguish places
};

/// What a pair of nodes says of their poses; no pose is thrown away.
struct GraphLink {
  int source = -1;
  int target = -1;
  LinkTrust trust = LinkTrust::measured;
  std::vector<LinkPose> poses;  ///< at least one; best first
  double look_alike = 0.0;      ///< probability that the best pose lays a place on another one built alike
  double chance = 0.0;          ///< probability that none of its poses is right, look-alikes aside
  /// Where the pair's best pose is among `poses`: elsewhere than first where a user chose another, which
  /// took its place.
  int best = 0;
  bool accepted = false;    ///< by a user
  bool by_targets = false;  ///< given by targets that both see, which enter the adjustment themselves

  /// Whether look-alike places were asked about: else they are among its poses.
  [[nodiscard]] bool asks_look_alike() const { return look_alike > 0.0 || poses.front().look_alike; }

  /// The number that the pair itself gives a pose.
  [[nodiscard]] int number_of(int pose) const { return pose == 0 ? best : pose == best ? 0 : pose; }
};

/// Nodes are scans and models: 0 .. nodes - 1, the lower ones first where one has to be chosen.
struct PoseGraph {
  int nodes = 0;
  std::vector<GraphLink> links;
  int anchor = -1;  ///< a node that is the frame of the component it is part of, -1: none
  /// Of each node, or of none, where its scanner was, in its own coordinates; of static scans.
  std::vector<std::optional<Vector3d>> scanners;
  /// Poses that were measured from where the links place two nodes: they say how exactly these lie there, and
  /// nothing of which place it is.
  std::vector<PoseEdge> measured_in_place;
};

/// The links of which a pose is accepted, as edges; `pose_of_link`: which one, -1: none.
std::vector<PoseEdge> edges_of(const PoseGraph& graph, const std::vector<int>& pose_of_link);

/// What became of a link.
enum class LinkState {
  verified,   ///< at least one loop that it is part of closes
  bridge,     ///< accepted, but part of no loop: nothing can check it
  ambiguous,  ///< another pose, here or elsewhere, explains as much
  rejected,   ///< contradicts the loops
  weak,       ///< leaves a direction free, or agrees with too little to count
  in_place    ///< measured from where the others place both: how exactly they lie there, not where
};
const char* to_string(LinkState state);

struct SolvedLink {
  LinkState state = LinkState::weak;
  int pose = -1;                ///< index of the accepted pose; -1: none
  double loop_error_m = 0.0;    ///< shift between the measured pose and that of the solution ...
  double loop_error_rad = 0.0;  ///< ... and turn; without meaning where the two ends are not joined
  double chi_square = 0.0;      ///< the same in standard deviations, squared; 6 freedoms
  double redundancy = 0.0;      ///< share of the link's six numbers that the others check, 0 .. 6
};

/// By what a measured pose misses the one of the solution.
void take_misfit(const LinkPose& measured, const Rigid3& target_from_source, SolvedLink& solved);

enum class NodeState {
  registered,
  probable,           ///< placed, but with a doubt above the risk
  ambiguous,          ///< another place explains as much
  under_constrained,  ///< held, but some direction is free
  floating            ///< joined to nothing
};
const char* to_string(NodeState state);
/// Whether one place is as good as certain.
inline bool is_placed(NodeState state) {
  return state == NodeState::registered || state == NodeState::probable;
}

struct SolvedNode {
  NodeState state = NodeState::floating;
  int component = -1;                      ///< 0: the one with most placed nodes; -1: joined to nothing
  Rigid3 frame_from_node;                  ///< in the frame of the first node of its component
  Matrix6d covariance = Matrix6d::Zero();  ///< of a turn about the node's origin and a shift; frame axes, SI
  std::vector<Rigid3> alternatives;        ///< other poses that explain as much; frame
  double doubt = 0.0;  ///< probability that it is elsewhere, by the least that holds it to the frame
};

/// Two ways to put one part of a component against the rest that the data cannot distinguish.
struct GraphQuestion {
  std::vector<int> moved;    ///< nodes that would move
  std::vector<int> current;  ///< links that support the present place only
  std::vector<int> rival;    ///< links that support the other place only
  Rigid3 frame_from_frame;   ///< how they would move; without meaning where `doubt` is set
  double doubt = 0.0;        ///< no other place is known, but the links are wrong with this probability
};

/// A loop of three or four links that was tested.
struct GraphLoop {
  std::vector<int> links;
  double error_m = 0.0;
  double error_rad = 0.0;
  double chi_square = 0.0;
  bool closes = false;
};

struct SolvedGraph {
  std::vector<SolvedNode> nodes;
  std::vector<SolvedLink> links;
  std::vector<bool> in_place;  ///< of each pose measured in place: the solution lays both nodes there
  std::vector<GraphLoop> loops;
  std::vector<GraphQuestion> questions;
  int components = 0;  ///< of two nodes or more
};

/// Puts all nodes that the links hold together into one frame per component.
///
/// The configuration that the pairs agree on best (configuration.h) is asked how surely each of its sides is
/// where it is (placement_odds.h), by the links, and with `query` by all pairs that it places in sight of
/// each other. A side that is more probably elsewhere leaves its component. The doubt of a node is the
/// probability that a side that it is part of is elsewhere, at a place that a link proposes or at none that
/// is known.
SolvedGraph solve_graph(const PoseGraph& graph, double risk = 0.001, const PoseQuery& query = {},
                        double probable_risk = 0.05);

}  // namespace limen
