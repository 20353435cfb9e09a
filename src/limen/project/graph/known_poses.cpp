// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/known_poses.h"

#include "limen/project/graph/pose_adjustment.h"

namespace limen {

std::vector<LinkPose> known_poses(const PoseGraph& graph, const SolvedGraph& solved,
                                  const std::vector<std::pair<int, int>>& pairs) {
  constexpr double kUnknown = 1e4;  // variance of an edge that says nothing: metres and radians
  std::vector<Rigid3> poses;
  std::vector<bool> fixed;
  for (const SolvedNode& node : solved.nodes) {
    poses.push_back(node.frame_from_node);
    fixed.push_back(node.component < 0 || node.covariance.isZero());
  }
  std::vector<PoseEdge> edges;
  for (std::size_t k = 0; k < graph.links.size(); ++k) {
    const GraphLink& link = graph.links[k];
    const int pose = solved.links[k].pose;
    if (pose >= 0) edges.push_back({link.source, link.target, link.poses[static_cast<std::size_t>(pose)]});
  }
  const std::size_t links = edges.size();
  std::vector<LinkPose> known;
  for (const auto& [source, target] : pairs) {
    LinkPose pose;
    pose.target_from_source =
        inverse(poses[static_cast<std::size_t>(target)]) * poses[static_cast<std::size_t>(source)];
    pose.covariance *= kUnknown;
    pose.centre = pose.target_from_source.translation;
    edges.push_back({source, target, pose});
    known.push_back(pose);
  }
  const PoseAdjustment adjusted = adjust_poses(poses, fixed, edges, {false, true});
  for (std::size_t k = 0; k < known.size(); ++k) known[k].covariance = adjusted.edge_covariance[links + k];
  return known;
}

}  // namespace limen
