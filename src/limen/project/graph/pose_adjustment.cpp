// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/pose_adjustment.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/SparseCholesky>

#include "limen/base/progress.h"

namespace limen {
namespace {

/// The first of the six unknowns of the node at a place.
Eigen::Index unknown(int place) {
  return Eigen::Index{6} * place;
}

Matrix3d skew(const Vector3d& v) {
  Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

class Adjuster {
 public:
  Adjuster(const std::vector<bool>& fixed, const std::vector<PoseEdge>& edges) : edges_(edges) {
    for (const bool is_fixed : fixed) place_.push_back(is_fixed ? -1 : size_++);
    for (const PoseEdge& edge : edges) information_.emplace_back(edge.pose.covariance.inverse());
  }

  /// One step; returns its largest shift in metres or radians.
  double step(std::vector<Rigid3>& poses, const std::vector<double>& weights) {
    if (size_ == 0) return 0.0;
    Eigen::VectorXd right = Eigen::VectorXd::Zero(unknown(size_));
    factor(poses, weights, right);
    const Eigen::VectorXd delta = solver_.solve(right);
    double largest = 0.0;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      if (place_[i] < 0) continue;
      const Vector6d d = delta.segment<6>(unknown(place_[i]));
      poses[i].rotation = nearest_rotation(rotation_exp(d.head<3>()) * poses[i].rotation);
      poses[i].translation += d.tail<3>();
      largest = std::max(largest, d.cwiseAbs().maxCoeff());
    }
    return largest;
  }

  void factor(const std::vector<Rigid3>& poses, const std::vector<double>& weights, Eigen::VectorXd& right) {
    std::vector<Eigen::Triplet<double>> entries;
    for (int k = 0; k < 6 * size_; ++k) entries.emplace_back(k, k, kTiny);
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      const PoseEdge& edge = edges_[e];
      const EdgeResidual line = edge_residual(edge, poses[static_cast<std::size_t>(edge.source)],
                                              poses[static_cast<std::size_t>(edge.target)]);
      const Matrix6d weight = weights[e] * information_[e];
      add(edge.source, edge.source, line.by_source.transpose() * weight * line.by_source, entries);
      add(edge.target, edge.target, line.by_target.transpose() * weight * line.by_target, entries);
      add(edge.source, edge.target, line.by_source.transpose() * weight * line.by_target, entries);
      add(edge.target, edge.source, line.by_target.transpose() * weight * line.by_source, entries);
      add_right(edge.source, -line.by_source.transpose() * weight * line.value, right);
      add_right(edge.target, -line.by_target.transpose() * weight * line.value, right);
    }
    Eigen::SparseMatrix<double> normal(unknown(size_), unknown(size_));
    normal.setFromTriplets(entries.begin(), entries.end());
    solver_.compute(normal);
  }

  /// Columns of the inverse for one node.
  [[nodiscard]] Eigen::MatrixXd columns(int node) const {
    const Eigen::Index at = unknown(place_[static_cast<std::size_t>(node)]);
    Eigen::MatrixXd unit = Eigen::MatrixXd::Zero(unknown(size_), 6);
    unit.block<6, 6>(at, 0).setIdentity();
    return solver_.solve(unit);
  }
  [[nodiscard]] int place(int node) const { return place_[static_cast<std::size_t>(node)]; }

 private:
  static constexpr double kTiny = 1e-9;  // keeps a node that nothing holds from breaking the rest

  void add(int row, int column, const Matrix6d& block, std::vector<Eigen::Triplet<double>>& entries) const {
    const int at_row = 6 * place(row);
    const int at_column = 6 * place(column);
    if (at_row < 0 || at_column < 0) return;
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j < 6; ++j) entries.emplace_back(at_row + i, at_column + j, block(i, j));
    }
  }
  void add_right(int row, const Vector6d& part, Eigen::VectorXd& right) const {
    if (place(row) >= 0) right.segment<6>(unknown(place(row))) += part;
  }

  const std::vector<PoseEdge>& edges_;
  std::vector<Matrix6d> information_;
  std::vector<int> place_;
  int size_ = 0;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver_;
};

constexpr int kRounds = 20;
constexpr int kSteps = 6;
constexpr double kDone = 1e-10;

/// Geman-McClure with a bound that shrinks to chi-square's (Yang et al., Graduated non-convexity, 2020, 4.1).
std::vector<double> robust_weights(const std::vector<PoseEdge>& edges, const std::vector<Rigid3>& poses,
                                   double control) {
  std::vector<double> weights;
  for (const PoseEdge& edge : edges) {
    const Rigid3 predicted =
        inverse(poses[static_cast<std::size_t>(edge.target)]) * poses[static_cast<std::size_t>(edge.source)];
    const double squared = chi_square(misfit(edge.pose, predicted), edge.pose.covariance);
    const double ratio = control * kChiSquareBound / (squared + control * kChiSquareBound);
    weights.push_back(ratio * ratio);
  }
  return weights;
}

void add_covariances(Adjuster& adjuster, const std::vector<PoseEdge>& edges, PoseAdjustment& result) {
  const std::size_t nodes = result.frame_from_node.size();
  Eigen::VectorXd right;
  result.covariance.assign(nodes, Matrix6d::Zero());
  result.edge_covariance.assign(edges.size(), Matrix6d::Zero());
  std::vector<std::vector<std::size_t>> of_source(nodes);
  for (std::size_t e = 0; e < edges.size(); ++e)
    of_source[static_cast<std::size_t>(edges[e].source)].push_back(e);
  const auto at = [&](const Eigen::MatrixXd& columns, int node) -> Matrix6d {
    if (adjuster.place(node) < 0) return Matrix6d::Zero();
    return columns.middleRows<6>(unknown(adjuster.place(node)));
  };
  std::vector<Matrix6d> across(edges.size(), Matrix6d::Zero());  // of target against source
  for (std::size_t i = 0; i < nodes; ++i) {
    CancelScope::check();
    if (adjuster.place(static_cast<int>(i)) < 0) continue;
    const Eigen::MatrixXd columns = adjuster.columns(static_cast<int>(i));
    result.covariance[i] = at(columns, static_cast<int>(i));
    for (const std::size_t e : of_source[i]) across[e] = at(columns, edges[e].target);
  }
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto source = static_cast<std::size_t>(edges[e].source);
    const auto target = static_cast<std::size_t>(edges[e].target);
    const EdgeResidual line =
        edge_residual(edges[e], result.frame_from_node[source], result.frame_from_node[target]);
    const Matrix6d mixed = line.by_target * across[e] * line.by_source.transpose();
    result.edge_covariance[e] = line.by_source * result.covariance[source] * line.by_source.transpose() +
                                line.by_target * result.covariance[target] * line.by_target.transpose() +
                                mixed + mixed.transpose();
  }
}

}  // namespace

EdgeResidual edge_residual(const PoseEdge& edge, const Rigid3& source, const Rigid3& target) {
  EdgeResidual line;
  line.value = misfit(edge.pose, inverse(target) * source);
  const Vector3d at = source * (inverse(edge.pose.target_from_source) * edge.pose.centre);
  const Matrix3d back = target.rotation.transpose();
  const auto fill = [&](const Vector3d& centre, double sign) {
    Matrix6d j = Matrix6d::Zero();
    j.topLeftCorner<3, 3>() = sign * back;
    j.bottomLeftCorner<3, 3>() = -sign * back * skew(at - centre);
    j.bottomRightCorner<3, 3>() = sign * back;
    return j;
  };
  line.by_source = fill(source.translation, 1.0);
  line.by_target = fill(target.translation, -1.0);
  return line;
}

PoseAdjustment adjust_poses(const std::vector<Rigid3>& start, const std::vector<bool>& fixed,
                            const std::vector<PoseEdge>& edges, const PoseAdjustmentOptions& options) {
  Adjuster adjuster(fixed, edges);
  PoseAdjustment result;
  result.frame_from_node = start;
  result.weights.assign(edges.size(), 1.0);
  double control = 64.0;
  for (int round = 0; round < kRounds; ++round) {
    CancelScope::check();
    if (options.robust) result.weights = robust_weights(edges, result.frame_from_node, control);
    double moved = 0.0;
    for (int step = 0; step < kSteps; ++step) {
      moved = adjuster.step(result.frame_from_node, result.weights);
      if (moved < kDone) break;
    }
    if (control <= 1.0 && moved < kDone) break;
    control = std::max(1.0, control / 2.0);
    if (!options.robust) break;
  }
  if (options.covariance) {
    Eigen::VectorXd right = Eigen::VectorXd::Zero(6 * static_cast<Eigen::Index>(start.size()));
    adjuster.factor(result.frame_from_node, result.weights, right);
    add_covariances(adjuster, edges, result);
  }
  return result;
}

}  // namespace limen
