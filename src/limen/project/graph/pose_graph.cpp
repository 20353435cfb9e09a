// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/pose_graph.h"

#include "limen/base/named.h"

namespace limen {

std::vector<PoseEdge> edges_of(const PoseGraph& graph, const std::vector<int>& pose_of_link) {
  std::vector<PoseEdge> edges;
  for (std::size_t k = 0; k < graph.links.size(); ++k) {
    const GraphLink& link = graph.links[k];
    if (pose_of_link[k] >= 0)
      edges.push_back({link.source, link.target, link.poses[static_cast<std::size_t>(pose_of_link[k])]});
  }
  return edges;
}

void take_misfit(const LinkPose& measured, const Rigid3& target_from_source, SolvedLink& solved) {
  const Vector6d missed = misfit(measured, target_from_source);
  solved.loop_error_rad = missed.head<3>().norm();
  solved.loop_error_m = missed.tail<3>().norm();
  solved.chi_square = chi_square(missed, measured.covariance);
}

const char* to_string(LinkState state) {
  static constexpr Named<LinkState> names[] = {
      {LinkState::verified, "verified"}, {LinkState::bridge, "bridge"}, {LinkState::ambiguous, "ambiguous"},
      {LinkState::rejected, "rejected"}, {LinkState::weak, "weak"},     {LinkState::in_place, "in_place"}};
  return name_of(names, state);
}

const char* to_string(NodeState state) {
  static constexpr Named<NodeState> names[] = {{NodeState::registered, "registered"},
                                               {NodeState::probable, "probable"},
                                               {NodeState::ambiguous, "ambiguous"},
                                               {NodeState::under_constrained, "under_constrained"},
                                               {NodeState::floating, "floating"}};
  return name_of(names, state);
}

}  // namespace limen
