// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/project/graph/link_pose.h"
#include "limen/project/graph/pose_system.h"

namespace limen {

/// One accepted pose between two nodes.
struct PoseEdge {
  int source = -1;
  int target = -1;
  LinkPose pose;
  bool stated = false;  ///< adjust_jointly() tells how well it is known afterwards
};

/// By how much an edge misses the poses of its ends, and the derivatives by small motions of them (turn about
/// the node's own origin, shift; frame axes).
struct EdgeResidual {
  Vector6d value;
  Matrix6d by_source;
  Matrix6d by_target;
};
EdgeResidual edge_residual(const PoseEdge& edge, const Rigid3& frame_from_source,
                           const Rigid3& frame_from_target);

/// Covariance of an edge's misfit after an adjustment; `system` is inverted.
Matrix6d covariance_of_edge(const PoseEdge& edge, const Rigid3& frame_from_source,
                            const Rigid3& frame_from_target, const PoseSystem& system);

/// Adds an edge's say, weighted by `information`, to what is asked of the nodes it joins.
void add_edge(const PoseEdge& edge, const std::vector<Rigid3>& poses, const Matrix6d& information,
              PoseSystem& system);

struct PoseAdjustment {
  std::vector<Rigid3> frame_from_node;
  std::vector<Matrix6d> covariance;       ///< of a turn about the node's origin and a shift; frame axes
  std::vector<Matrix6d> edge_covariance;  ///< of the adjusted pose of each edge, as in LinkPose
  std::vector<double> weights;            ///< robust weight of each edge, 0 .. 1
};

struct PoseAdjustmentOptions {
  bool robust = true;       ///< graduated Geman-McClure weights; else plain least squares
  bool covariance = false;  ///< fill the covariances
};

/// Least squares over edges (Gauss-Newton, sparse Cholesky). Nodes with `fixed[i]` keep their pose; every
/// other node must be joined to a fixed one by edges.
PoseAdjustment adjust_poses(const std::vector<Rigid3>& start, const std::vector<bool>& fixed,
                            const std::vector<PoseEdge>& edges, const PoseAdjustmentOptions& options = {});

/// How well an adjustment by `edges` knows other poses: covariances of the adjusted poses of the `asked`
/// pairs of nodes, about the centres of their poses, as in LinkPose. What they are `asked` with holds
/// nothing.
std::vector<Matrix6d> covariances_of(const std::vector<Rigid3>& start, const std::vector<bool>& fixed,
                                     std::vector<PoseEdge> edges, const std::vector<PoseEdge>& asked);

}  // namespace limen
