// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/adjust/plane_adjustment.h"

#include "support/synthetic_graph.h"
#include <gtest/gtest.h>

namespace limen {
namespace {

/// Points of the plane {x : n . x = d} of the frame near `middle`, as a node sees them.
PlaneObservation seen_plane(int node, int plane, const Rigid3& frame_from_node, const Plane& truth,
                            const Vector3d& middle, double noise_m, RandomStream& random) {
  PlaneObservation seen;
  seen.node = node;
  seen.plane = plane;
  const PlaneFrame frame = make_frame(truth, middle);
  const Rigid3 node_from_frame = inverse(frame_from_node);
  seen.anchor = node_from_frame * frame.origin;
  for (int k = 0; k < 40; ++k) {
    const Vector3d point = frame.to_space({random.uniform(-2, 2), random.uniform(-1.2, 1.2)}) +
                           noise_m * random.normal() * truth.normal;
    seen.moments.add(node_from_frame * point - seen.anchor);
  }
  seen.most_points = 40.0;
  return seen;
}

Rigid3 nudged(const Rigid3& pose, Eigen::Index k, double step) {
  Vector6d d = Vector6d::Zero();
  d[k] = step;
  return {rotation_exp(d.head<3>()) * pose.rotation, pose.translation + d.tail<3>()};
}

TEST(PlaneAdjustment, DerivativesAreThoseOfDifferences) {
  RandomStream random(1);
  const Rigid3 pose = random_pose(random, 3.0);
  const Plane truth{Vector3d(0.6, 0.0, 0.8), 2.0};
  const PlaneObservation seen = seen_plane(0, 0, pose, truth, {1, 2, 0.5}, 0.01, random);
  const PlaneFrame frame = make_frame(truth, {0.5, 1.5, 1});
  const AnchoredPlane plane{frame.origin, truth.normal, 0.03, frame.u, frame.v};
  const Eigen::Matrix4d factor = moment_factor(seen);
  const PlaneResidual residual = plane_residual(factor, pose, plane);
  constexpr double kStep = 1e-6;
  for (Eigen::Index k = 0; k < 6; ++k) {
    const Eigen::Vector4d slope = (plane_residual(factor, nudged(pose, k, kStep), plane).value -
                                   plane_residual(factor, nudged(pose, k, -kStep), plane).value) /
                                  (2 * kStep);
    EXPECT_LT((slope - residual.by_pose.col(k)).norm(), 1e-5 * (1.0 + slope.norm())) << k;
  }
  for (Eigen::Index k = 0; k < 3; ++k) {
    const auto with = [&](double step) {
      AnchoredPlane moved = plane;
      if (k == 0) moved.normal += step * plane.u;
      if (k == 1) moved.normal += step * plane.v;
      if (k == 2) moved.offset += step;
      return plane_residual(factor, pose, moved).value;
    };
    const Eigen::Vector4d slope = (with(kStep) - with(-kStep)) / (2 * kStep);
    EXPECT_LT((slope - residual.by_plane.col(k)).norm(), 1e-5 * (1.0 + slope.norm())) << k;
  }
}

/// A chain of nodes from the first, which is fixed, and an edge of its own uncertainty to each next one.
JointProblem chain(int nodes, RandomStream& random) {
  JointProblem problem;
  problem.fixed.assign(static_cast<std::size_t>(nodes), false);
  problem.fixed.front() = true;
  for (int k = 0; k < nodes; ++k) problem.frame_from_node.push_back(random_pose(random, 3.0));
  for (int k = 1; k < nodes; ++k) {
    PoseEdge edge;
    edge.source = k;
    edge.target = k - 1;
    edge.pose.target_from_source = inverse(problem.frame_from_node[static_cast<std::size_t>(k - 1)]) *
                                   problem.frame_from_node[static_cast<std::size_t>(k)];
    edge.pose.centre = random_pose(random, 2.0).translation;
    Vector6d sigma;
    for (double& one : sigma) one = 0.01 * random.uniform(0.5, 2.0);
    edge.pose.covariance = sigma.cwiseAbs2().asDiagonal();
    edge.stated = true;
    problem.edges.push_back(edge);
  }
  return problem;
}

TEST(PlaneAdjustment, AnEdgeThatNothingChecksKeepsItsUncertaintyAndTwoAlikeHalveIt) {
  RandomStream random(5);
  JointProblem problem = chain(5, random);
  const auto check = [&](std::size_t e, double share) {
    const JointSolution solution = adjust_jointly(problem);
    const Matrix6d wanted = share * problem.edges[e].pose.covariance;
    EXPECT_LT((solution.edge_covariance[e] - wanted).norm(), 1e-3 * wanted.norm()) << e;
  };
  for (std::size_t e = 0; e < problem.edges.size(); ++e) check(e, 1.0);
  problem.edges.push_back(problem.edges[2]);
  check(1, 1.0);
  check(2, 0.5);
}

TEST(PlaneAdjustment, EdgeDerivativesAreThoseOfDifferences) {
  RandomStream random(2);
  const Rigid3 source = random_pose(random, 4.0);
  const Rigid3 target = random_pose(random, 4.0);
  const PoseEdge edge{0, 1, measured_pose(inverse(target) * source, 10.0, random)};
  const EdgeResidual residual = edge_residual(edge, source, target);
  constexpr double kStep = 1e-6;
  for (Eigen::Index k = 0; k < 6; ++k) {
    const Vector6d by_source = (edge_residual(edge, nudged(source, k, kStep), target).value -
                                edge_residual(edge, nudged(source, k, -kStep), target).value) /
                               (2 * kStep);
    const Vector6d by_target = (edge_residual(edge, source, nudged(target, k, kStep)).value -
                                edge_residual(edge, source, nudged(target, k, -kStep)).value) /
                               (2 * kStep);
    // The turn of a small misfit is linear but for a part of its size.
    EXPECT_LT((by_source - residual.by_source.col(k)).norm(), 2e-3) << k;
    EXPECT_LT((by_target - residual.by_target.col(k)).norm(), 2e-3) << k;
  }
}

TEST(PlaneAdjustment, SharedPlanesBringPosesToTheTruthAndFarPlanesDoNotHarm) {
  RandomStream random(3);
  // Far from the origin: planes are anchored at their own centroids.
  const Vector3d far(140.0, -90.0, 12.0);
  const std::vector<Plane> walls = {{Vector3d::UnitX(), far.x()}, {-Vector3d::UnitX(), -far.x() - 6.0},
                                    {Vector3d::UnitY(), far.y()}, {-Vector3d::UnitY(), -far.y() - 5.0},
                                    {Vector3d::UnitZ(), far.z()}, {-Vector3d::UnitZ(), -far.z() - 3.0}};
  JointProblem problem;
  std::vector<Rigid3> truth;
  for (int n = 0; n < 4; ++n) {
    Rigid3 pose = random_pose(random, 2.0);
    pose.translation += far + Vector3d(3, 2.5, 1.5);
    truth.push_back(pose);
    problem.fixed.push_back(n == 0);
    problem.frame_from_node.push_back(n == 0 ? pose : measured_pose(pose, 10.0, random).target_from_source);
  }
  problem.planes = static_cast<int>(walls.size());
  for (int n = 0; n < 4; ++n) {
    for (int p = 0; p < problem.planes; ++p)
      problem.observations.push_back(seen_plane(n, p, truth[static_cast<std::size_t>(n)],
                                                walls[static_cast<std::size_t>(p)],
                                                far + Vector3d(3, 2.5, 1.5), 0.002, random));
    if (n > 0) {
      LinkPose link = measured_pose(inverse(truth[0]) * truth[static_cast<std::size_t>(n)], 10.0, random);
      problem.edges.push_back({n, 0, link});
    }
  }
  const JointSolution solution = adjust_jointly(problem);
  for (std::size_t n = 1; n < 4; ++n) {
    const Rigid3 error = solution.frame_from_node[n] * inverse(truth[n]);
    EXPECT_LT(rotation_angle(error.rotation), 0.0008);
    EXPECT_LT((solution.frame_from_node[n].translation - truth[n].translation).norm(), 0.0015);
    EXPECT_GT(solution.covariance[n](3, 3), 0.0);
    EXPECT_LT(solution.covariance[n](3, 3), 1e-6);
  }
  EXPECT_GT(solution.variance_factor, 0.4);
  EXPECT_LT(solution.variance_factor, 2.0);
}

TEST(PlaneAdjustment, AnObservationOfAnotherWallLosesItsWeight) {
  RandomStream random(4);
  JointProblem problem;
  const std::vector<Plane> walls = {{Vector3d::UnitX(), 3.0},
                                    {Vector3d::UnitY(), 2.0},
                                    {Vector3d::UnitZ(), 0.0},
                                    {-Vector3d::UnitX(), 2.0}};
  for (int n = 0; n < 4; ++n) {
    problem.frame_from_node.emplace_back();
    problem.fixed.push_back(n == 0);
    if (n > 0) problem.edges.push_back({n, 0, measured_pose(Rigid3{}, 10.0, random)});
    for (int p = 0; p < 4; ++p) {
      Plane wall = walls[static_cast<std::size_t>(p)];
      if (n == 3 && p == 0) wall.offset += 0.03;
      problem.observations.push_back(seen_plane(n, p, {}, wall, {0, 0, 1}, 0.001, random));
    }
  }
  problem.planes = 4;
  const JointSolution solution = adjust_jointly(problem);
  EXPECT_LT(solution.weights[12], 0.2);
  EXPECT_GT(solution.weights[0], 0.8);
  EXPECT_LT(solution.frame_from_node[3].translation.norm(), 0.008);
}

}  // namespace
}  // namespace limen
