// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/pose_adjustment.h"

#include <algorithm>
#include <cmath>

#include "limen/base/progress.h"
#include "limen/geometry/linear.h"

namespace limen {
namespace {

class Adjuster {
 public:
  Adjuster(const std::vector<bool>& fixed, const std::vector<PoseEdge>& edges)
      : edges_(edges), system_(fixed) {
    for (const PoseEdge& edge : edges) information_.push_back(inverse_of(edge.pose.covariance));
  }

  /// One step; returns its largest shift in metres or radians.
  double step(std::vector<Rigid3>& poses, const std::vector<double>& weights) {
    if (system_.empty()) return 0.0;
    factor(poses, weights);
    return system_.move(poses);
  }

  void factor(const std::vector<Rigid3>& poses, const std::vector<double>& weights) {
    system_.clear();
    for (std::size_t e = 0; e < edges_.size(); ++e)
      add_edge(edges_[e], poses, weights[e] * information_[e], system_);
    system_.factor();
  }

  /// Geman-McClure with a bound that shrinks to chi-square's (Yang et al., Graduated non-convexity,
  /// 2020, 4.1).
  [[nodiscard]] std::vector<double> robust_weights(const std::vector<Rigid3>& poses, double control) const {
    std::vector<double> weights;
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      const PoseEdge& edge = edges_[e];
      const Rigid3 predicted = inverse(poses[static_cast<std::size_t>(edge.target)]) *
                               poses[static_cast<std::size_t>(edge.source)];
      const Vector6d missed = misfit(edge.pose, predicted);
      const double squared = missed.dot(information_[e] * missed);
      const double ratio = control * kChiSquareBound / (squared + control * kChiSquareBound);
      weights.push_back(ratio * ratio);
    }
    return weights;
  }

  void invert() { system_.invert(); }
  [[nodiscard]] const PoseSystem& system() const { return system_; }

 private:
  const std::vector<PoseEdge>& edges_;
  std::vector<Matrix6d> information_;
  PoseSystem system_;
};

constexpr int kEdgeRounds = 20;
constexpr int kEdgeSteps = 6;
constexpr double kEdgesDone = 1e-10;
constexpr double kOnTheWay = 1e-3;  // while the bound still shrinks

void add_covariances(const Adjuster& adjuster, const std::vector<PoseEdge>& edges, PoseAdjustment& result) {
  const std::size_t nodes = result.frame_from_node.size();
  const PoseSystem& system = adjuster.system();
  result.covariance.assign(nodes, Matrix6d::Zero());
  result.edge_covariance.assign(edges.size(), Matrix6d::Zero());
  for (std::size_t i = 0; i < nodes; ++i)
    result.covariance[i] = system.inverse_block(static_cast<int>(i), static_cast<int>(i));
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto source = static_cast<std::size_t>(edges[e].source);
    const auto target = static_cast<std::size_t>(edges[e].target);
    result.edge_covariance[e] =
        covariance_of_edge(edges[e], result.frame_from_node[source], result.frame_from_node[target], system);
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

Matrix6d covariance_of_edge(const PoseEdge& edge, const Rigid3& source, const Rigid3& target,
                            const PoseSystem& system) {
  const EdgeResidual line = edge_residual(edge, source, target);
  const Matrix6d mixed =
      line.by_target * system.inverse_block(edge.target, edge.source) * line.by_source.transpose();
  return line.by_source * system.inverse_block(edge.source, edge.source) * line.by_source.transpose() +
         line.by_target * system.inverse_block(edge.target, edge.target) * line.by_target.transpose() +
         mixed + mixed.transpose();
}

void add_edge(const PoseEdge& edge, const std::vector<Rigid3>& poses, const Matrix6d& information,
              PoseSystem& system) {
  const EdgeResidual line = edge_residual(edge, poses[static_cast<std::size_t>(edge.source)],
                                          poses[static_cast<std::size_t>(edge.target)]);
  const Matrix6d of_source = line.by_source.transpose() * information;
  const Matrix6d of_target = line.by_target.transpose() * information;
  system.add(edge.source, edge.source, of_source * line.by_source);
  system.add(edge.target, edge.target, of_target * line.by_target);
  system.add(edge.source, edge.target, of_source * line.by_target);
  system.add(edge.target, edge.source, of_target * line.by_source);
  system.add_right(edge.source, -of_source * line.value);
  system.add_right(edge.target, -of_target * line.value);
}

PoseAdjustment adjust_poses(const std::vector<Rigid3>& start, const std::vector<bool>& fixed,
                            const std::vector<PoseEdge>& edges, const PoseAdjustmentOptions& options) {
  Adjuster adjuster(fixed, edges);
  PoseAdjustment result;
  result.frame_from_node = start;
  result.weights.assign(edges.size(), 1.0);
  double control = 64.0;
  for (int round = 0; round < kEdgeRounds; ++round) {
    CancelScope::check();
    if (options.robust) result.weights = adjuster.robust_weights(result.frame_from_node, control);
    double moved = 0.0;
    const double done = options.robust && control > 1.0 ? kOnTheWay : kEdgesDone;
    for (int step = 0; step < kEdgeSteps; ++step) {
      moved = adjuster.step(result.frame_from_node, result.weights);
      if (moved < done) break;
    }
    if (control <= 1.0 && moved < kEdgesDone) break;
    control = std::max(1.0, control / 2.0);
    if (!options.robust) break;
  }
  if (options.covariance) {
    adjuster.factor(result.frame_from_node, result.weights);
    adjuster.invert();
    add_covariances(adjuster, edges, result);
  }
  return result;
}

std::vector<Matrix6d> covariances_of(const std::vector<Rigid3>& start, const std::vector<bool>& fixed,
                                     std::vector<PoseEdge> edges, const std::vector<PoseEdge>& asked) {
  constexpr double kHoldsNothing = 1e6;  // variance
  const auto first = static_cast<std::ptrdiff_t>(edges.size());
  for (const PoseEdge& edge : asked) {
    edges.push_back(edge);
    edges.back().pose.covariance = kHoldsNothing * Matrix6d::Identity();
  }
  const PoseAdjustment adjusted = adjust_poses(start, fixed, edges, {false, true});
  return {adjusted.edge_covariance.begin() + first, adjusted.edge_covariance.end()};
}

}  // namespace limen
