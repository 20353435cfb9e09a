// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/known_poses.h"

#include "limen/project/graph/pose_adjustment.h"

namespace limen {

std::vector<LinkPose> known_poses(const PoseGraph& graph, const SolvedGraph& solved,
                                  const std::vector<std::pair<int, int>>& pairs) {
  std::vector<Rigid3> poses;
  std::vector<bool> fixed;
  for (const SolvedNode& node : solved.nodes) {
    poses.push_back(node.frame_from_node);
    fixed.push_back(node.component < 0 || node.covariance.isZero());
  }
  std::vector<int> pose_of_link;
  for (const SolvedLink& link : solved.links) pose_of_link.push_back(link.pose);
  std::vector<PoseEdge> asked;
  std::vector<LinkPose> known;
  for (const auto& [source, target] : pairs) {
    LinkPose pose;
    pose.target_from_source =
        inverse(poses[static_cast<std::size_t>(target)]) * poses[static_cast<std::size_t>(source)];
    pose.centre = pose.target_from_source.translation;
    asked.push_back({source, target, pose});
    known.push_back(pose);
  }
  const std::vector<Matrix6d> covariances =
      covariances_of(poses, fixed, edges_of(graph, pose_of_link), asked);
  for (std::size_t k = 0; k < known.size(); ++k) known[k].covariance = covariances[k];
  return known;
}

}  // namespace limen
