// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/geometry/plane.h"
#include "limen/project/adjust/survey_point.h"
#include "limen/project/graph/pose_adjustment.h"

namespace limen {

/// What one node saw of a plane: all its points by their ten moments.
struct PlaneObservation {
  int node = -1;
  int plane = -1;
  PointMoments moments;                ///< about `anchor`, axes of the node
  Vector3d anchor = Vector3d::Zero();  ///< in the node's frame
  double sigma_m = 0.002;              ///< one standard deviation of one of the points that count
  double most_points = 16.0;           ///< as many count at most: neighbours err alike
};

/// Poses, the planes they share, and the links that hold what planes do not.
struct JointProblem {
  std::vector<Rigid3> frame_from_node;
  std::vector<bool> fixed;
  std::vector<PoseEdge> edges;
  std::vector<PlaneObservation> observations;
  int planes = 0;
  std::vector<MarkedPoint> points;
  /// Of each node: of which others its motion is made; empty: it has freedoms of its own, as all beyond the
  /// last of these have. Poses of a blend and of its nodes differ by small motions only.
  std::vector<NodeBlend> blends;
  std::vector<bool> unreported;  ///< nodes whose covariance nobody asks for; may be shorter than the nodes
};

struct JointSolution {
  std::vector<Rigid3> frame_from_node;
  std::vector<Matrix6d> covariance;  ///< of a turn about the node's origin and a shift; frame axes
  std::vector<double> weights;       ///< of each observation, 0 .. 1
  double variance_factor = 1.0;      ///< of the planes: 1 where they err as they should
  /// Of each edge that is `stated`: covariance of its adjusted misfit (edge_residual) where all err by what
  /// was taken for them, else zero. Empty where none is.
  std::vector<Matrix6d> edge_covariance;
  /// Of each point: covariance of the places where its sights have it by the poses alone, three rows each.
  std::vector<Eigen::MatrixXd> sight_covariance;
};

/// The four numbers whose squares are the weighted squared distances of an observation's points to a plane,
/// and their derivatives by a small motion of the node (turn about its origin, shift; frame axes) and of the
/// plane (two tilts, offset along the normal at the plane's anchor).
struct PlaneResidual {
  Eigen::Vector4d value;
  Eigen::Matrix<double, 4, 6> by_pose;
  Eigen::Matrix<double, 4, 3> by_plane;
};

/// A plane about an anchor near its points: {x : normal . (x - anchor) = offset}, and two directions in it.
struct AnchoredPlane {
  Vector3d anchor = Vector3d::Zero();
  Vector3d normal = Vector3d::UnitZ();
  double offset = 0.0;
  Vector3d u = Vector3d::UnitX();
  Vector3d v = Vector3d::UnitY();
};

/// F^T with F F^T = the weighted moments [p; 1][p; 1]^T, p in the node's frame.
Eigen::Matrix4d moment_factor(const PlaneObservation& observation);

/// Exact point-to-plane residuals at a cost that does not depend on the number of points: the 4 x 4 matrix of
/// moments is factored once.
PlaneResidual plane_residual(const Eigen::Matrix4d& factor, const Rigid3& frame_from_node,
                             const AnchoredPlane& plane);

/// Robust least squares over all poses and planes; planes are eliminated (Schur), the poses solved by sparse
/// Cholesky. An observation that misses its plane by far loses its weight (Geman-McClure). Every node that is
/// not fixed must be joined to a fixed one by edges, or hang with others on marked points whose coordinates
/// are known. Marked points are eliminated like planes. Where there are any, planes that miss by more than
/// was taken for them count for less, so that deviations of points and planes are of one measure.
JointSolution adjust_jointly(const JointProblem& problem);

}  // namespace limen
