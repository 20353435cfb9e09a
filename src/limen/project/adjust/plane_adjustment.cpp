// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/adjust/plane_adjustment.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "limen/base/parallel.h"
#include "limen/base/progress.h"
#include "limen/geometry/linear.h"

namespace limen {
namespace {

constexpr int kPlaneSteps = 12;
constexpr double kPlanesDone = 1e-9;
constexpr double kMissed =
    9.0;  // mean squared deviations at which an observation has lost three quarters of its weight
constexpr double kTinyInformation = 1e-9;
constexpr std::size_t kAtOnce = 64;

class JointSolver {
 public:
  explicit JointSolver(const JointProblem& problem)
      : problem_(problem), system_(problem.fixed, problem.blends) {
    for (const PoseEdge& edge : problem.edges) information_.push_back(inverse_of(edge.pose.covariance));
    seen_by_.resize(static_cast<std::size_t>(problem.planes));
    for (std::size_t k = 0; k < problem.observations.size(); ++k)
      seen_by_[static_cast<std::size_t>(problem.observations[k].plane)].push_back(k);
    solution_.frame_from_node = problem.frame_from_node;
    for (const PlaneObservation& seen : problem.observations) factors_.push_back(moment_factor(seen));
    solution_.weights.assign(problem.observations.size(), 1.0);
  }

  JointSolution run() {
    converge();
    tell_edges();
    tell_factor();
    if (!problem_.points.empty() && solution_.variance_factor > 1.0) {
      const double factor = solution_.variance_factor;
      plane_share_ = 1.0 / factor;
      converge();
      tell_edges();
    }
    tell_covariance();
    return std::move(solution_);
  }

 private:
  using Wide = Eigen::Matrix<double, 6, 3>;

  [[nodiscard]] const Rigid3& pose(int node) const {
    return solution_.frame_from_node[static_cast<std::size_t>(node)];
  }

  void converge() {
    if (system_.empty()) return;
    for (int step = 0; step < kPlaneSteps; ++step) {
      CancelScope::check();
      fit_planes();
      weigh();
      if (move() < kPlanesDone) break;
    }
    fit_planes();
    weigh();
    build();
  }

  /// Each plane anew from all that is seen of it, about its centroid.
  void fit_planes() {
    planes_.assign(seen_by_.size(), {});
    parallel_for(seen_by_.size(), kAtOnce, [&](std::size_t begin, std::size_t end) {
      for (std::size_t p = begin; p < end; ++p) {
        if (seen_by_[p].empty()) continue;
        const PlaneObservation& first = problem_.observations[seen_by_[p].front()];
        const Vector3d about = pose(first.node) * first.anchor;
        PointMoments all;
        for (const std::size_t k : seen_by_[p]) add_moments(k, about, all);
        const PlaneFit fit = fit_plane(all);
        const PlaneFrame frame = make_frame(fit.plane, fit.centroid);
        planes_[p] = {about + fit.centroid, fit.plane.normal, 0.0, frame.u, frame.v};
      }
    });
  }

  /// The points of an observation in the frame about `about`, weighted.
  void add_moments(std::size_t k, const Vector3d& about, PointMoments& all) const {
    const PlaneObservation& seen = problem_.observations[k];
    const Rigid3& node = pose(seen.node);
    const double count =
        std::min(seen.moments.count, seen.most_points) * solution_.weights[k] / (seen.sigma_m * seen.sigma_m);
    const Vector3d mean = node * (seen.anchor + seen.moments.mean()) - about;
    const Matrix3d spread = node.rotation * seen.moments.covariance() * node.rotation.transpose();
    all.count += count;
    all.sum += count * mean;
    all.outer += count * (spread + mean * mean.transpose());
  }

  void weigh() {
    parallel_for(problem_.observations.size(), kAtOnce, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        const PlaneObservation& seen = problem_.observations[k];
        const PlaneResidual residual =
            plane_residual(factors_[k], pose(seen.node), planes_[static_cast<std::size_t>(seen.plane)]);
        const double mean = residual.value.squaredNorm() / std::min(seen.moments.count, seen.most_points);
        const double ratio = kMissed / (kMissed + mean);
        solution_.weights[k] = ratio * ratio;
      }
    });
  }

  void build() {
    system_.clear();
    for (std::size_t e = 0; e < problem_.edges.size(); ++e)
      add_edge(problem_.edges[e], solution_.frame_from_node, information_[e], system_);
    for (std::size_t p = 0; p < seen_by_.size(); ++p) add_plane(p);
    for (const MarkedPoint& point : problem_.points) add_point(point);
    system_.factor();
  }

  double move() {
    build();
    return system_.move(solution_.frame_from_node);
  }

  /// Adds what a plane says of the poses that see it, the plane itself eliminated.
  void add_plane(std::size_t p) {
    const std::vector<std::size_t>& seen = seen_by_[p];
    if (seen.size() < 2) return;
    Matrix3d own = kTinyInformation * Matrix3d::Identity();
    Vector3d own_right = Vector3d::Zero();
    std::map<int, Wide> mixed;  // of each place of freedoms: many parts of a pass may see one plane
    for (const std::size_t k : seen) {
      const PlaneObservation& observation = problem_.observations[k];
      const double weight = plane_share_ * solution_.weights[k];
      const PlaneResidual residual = plane_residual(factors_[k], pose(observation.node), planes_[p]);
      own += weight * residual.by_plane.transpose() * residual.by_plane;
      own_right -= weight * residual.by_plane.transpose() * residual.value;
      const Wide own_mixed = weight * residual.by_pose.transpose() * residual.by_plane;
      for (const auto& [place, share] : system_.shares(observation.node))
        mixed.try_emplace(place, Wide::Zero()).first->second += share * own_mixed;
      system_.add(observation.node, observation.node,
                  weight * residual.by_pose.transpose() * residual.by_pose);
      system_.add_right(observation.node, -weight * residual.by_pose.transpose() * residual.value);
    }
    const Matrix3d inverted = inverse_of(own);
    for (const auto& [row, of_row] : mixed) {
      const Wide half = of_row * inverted;
      system_.add_right_at(row, -half * own_right);
      for (const auto& [column, of_column] : mixed)
        system_.add_at(row, column, -half * of_column.transpose());
    }
  }

  /// Adds what the sights of a point say of their poses, the point itself eliminated.
  void add_point(const MarkedPoint& point) {
    if (!point.enters || point.sights.empty()) return;
    const PointTerms terms = point_terms(point, solution_.frame_from_node);
    const Matrix3d inverted = inverse_of(terms.own);
    for (std::size_t i = 0; i < point.sights.size(); ++i) {
      const int node = point.sights[i].node;
      const Wide half = terms.by_pose[i].transpose() * terms.weight[i];
      system_.add(node, node, half * terms.by_pose[i]);
      system_.add_right(node, -half * (terms.place[i] - terms.x));
      for (std::size_t j = 0; j < point.sights.size(); ++j)
        system_.add(node, point.sights[j].node, -half * inverted * terms.weight[j] * terms.by_pose[j]);
    }
  }

  void tell_factor() {
    if (system_.empty()) return;
    double sum = 0.0;
    double count = held_by_stated() - 6.0 * system_.moving();
    for (std::size_t k = 0; k < problem_.observations.size(); ++k) {
      const PlaneObservation& seen = problem_.observations[k];
      const std::size_t plane = static_cast<std::size_t>(seen.plane);
      if (seen_by_[plane].size() < 2) continue;
      // What a plane's own thickness leaves is no contradiction between scans.
      const PlaneResidual residual = plane_residual(factors_[k], pose(seen.node), planes_[plane]);
      sum += solution_.weights[k] * (residual.value.squaredNorm() - own_misfit(seen));
      count += 3.0 * solution_.weights[k];
    }
    for (const std::vector<std::size_t>& seen : seen_by_) count -= seen.size() < 2 ? 0.0 : 3.0;
    if (count > 0.0) solution_.variance_factor = sum / count;
  }

  void tell_covariance() {
    solution_.covariance.assign(problem_.fixed.size(), Matrix6d::Zero());
    for (const MarkedPoint& point : problem_.points) solution_.sight_covariance.push_back(of_sights(point));
    if (system_.empty()) return;
    system_.invert();
    const double scale = problem_.points.empty() ? std::max(1.0, solution_.variance_factor) : 1.0;
    for (std::size_t i = 0; i < problem_.fixed.size(); ++i) {
      CancelScope::check();
      const int node = static_cast<int>(i);
      if (!system_.moves(node) || (i < problem_.unreported.size() && problem_.unreported[i])) continue;
      solution_.covariance[i] = scale * system_.inverse_block(node, node);
    }
  }

  /// Of all freedoms those that edges to be reported hold, and planes do not: so much of their misfits the
  /// covariances have left.
  [[nodiscard]] double held_by_stated() const {
    double held = 0.0;
    for (std::size_t e = 0; e < solution_.edge_covariance.size(); ++e) {
      if (problem_.edges[e].stated) held += (information_[e] * solution_.edge_covariance[e]).trace();
    }
    return held;
  }

  void tell_edges() {
    if (system_.empty()) return;
    const bool any = std::any_of(problem_.edges.begin(), problem_.edges.end(),
                                 [](const PoseEdge& edge) { return edge.stated; });
    if (!any) return;
    solution_.edge_covariance.assign(problem_.edges.size(), Matrix6d::Zero());
    for (std::size_t e = 0; e < problem_.edges.size(); ++e) {
      const PoseEdge& edge = problem_.edges[e];
      if (!edge.stated) continue;
      CancelScope::check();
      const EdgeResidual residual = edge_residual(edge, pose(edge.source), pose(edge.target));
      Matrix6d covariance = Matrix6d::Zero();
      const auto add = [&](int a, const Matrix6d& by_a) {
        if (!system_.moves(a)) return;
        const Eigen::MatrixXd columns = system_.inverse_columns(a);
        covariance += residual.by_source * system_.block_of(columns, edge.source) * by_a.transpose();
        covariance += residual.by_target * system_.block_of(columns, edge.target) * by_a.transpose();
      };
      add(edge.source, residual.by_source);
      add(edge.target, residual.by_target);
      solution_.edge_covariance[e] = covariance;
    }
  }

  [[nodiscard]] Eigen::MatrixXd of_sights(const MarkedPoint& point) const {
    const auto rows = static_cast<Eigen::Index>(3 * point.sights.size());
    if (system_.empty()) return Eigen::MatrixXd::Zero(rows, rows);
    const PointTerms terms = point_terms(point, solution_.frame_from_node);
    Eigen::MatrixXd by_poses = Eigen::MatrixXd::Zero(system_.unknowns(), rows);
    for (std::size_t i = 0; i < point.sights.size(); ++i) {
      for (const auto& [place, share] : system_.shares(point.sights[i].node))
        by_poses.block<6, 3>(Eigen::Index{6} * place, static_cast<Eigen::Index>(3 * i)) +=
            share * terms.by_pose[i].transpose();
    }
    return by_poses.transpose() * system_.solved(by_poses);
  }

  /// Weighted squared distances of an observation's points to the plane that fits them best.
  static double own_misfit(const PlaneObservation& seen) {
    const Spectrum3 spectrum = spectrum_of(seen.moments.covariance());
    return std::max(0.0, spectrum.values[0]) * std::min(seen.moments.count, seen.most_points) /
           (seen.sigma_m * seen.sigma_m);
  }

  const JointProblem& problem_;
  JointSolution solution_;
  double plane_share_ = 1.0;  // of the weight that planes are given
  std::vector<Matrix6d> information_;
  std::vector<Eigen::Matrix4d> factors_;  ///< of the observations' moments
  std::vector<std::vector<std::size_t>> seen_by_;
  std::vector<AnchoredPlane> planes_;
  PoseSystem system_;
};

}  // namespace

Eigen::Matrix4d moment_factor(const PlaneObservation& observation) {
  const Spectrum3 spectrum = spectrum_of(observation.moments.covariance());
  const double count = std::min(observation.moments.count, observation.most_points);
  Eigen::Matrix4d factor = Eigen::Matrix4d::Zero();
  factor.topLeftCorner<3, 3>() = spectrum.vectors * spectrum.values.cwiseMax(0.0).cwiseSqrt().asDiagonal();
  factor.topRightCorner<3, 1>() = observation.anchor + observation.moments.mean();
  factor(3, 3) = 1.0;
  return std::sqrt(count) / observation.sigma_m * factor.transpose();
}

PlaneResidual plane_residual(const Eigen::Matrix4d& factor, const Rigid3& frame_from_node,
                             const AnchoredPlane& plane) {
  // distance(p) = n . (R p + t - a) - o = w . [p; 1]
  const Matrix3d back = frame_from_node.rotation.transpose();
  const Vector3d from_anchor = frame_from_node.translation - plane.anchor;
  const auto row = [&](const Vector3d& direction, double constant) {
    Eigen::Vector4d w;
    w << back * direction, constant;
    return Eigen::Vector4d(factor * w);
  };
  PlaneResidual residual;
  residual.value = row(plane.normal, plane.normal.dot(from_anchor) - plane.offset);
  for (Eigen::Index k = 0; k < 3; ++k) {
    // A turn about the node's origin moves p by e x (R p): n . (e x R p) = (n x e) . R p.
    residual.by_pose.col(k) = row(plane.normal.cross(Vector3d::Unit(k)), 0.0);
    residual.by_pose.col(3 + k) = row(Vector3d::Zero(), plane.normal[k]);
  }
  residual.by_plane.col(0) = row(plane.u, plane.u.dot(from_anchor));
  residual.by_plane.col(1) = row(plane.v, plane.v.dot(from_anchor));
  residual.by_plane.col(2) = row(Vector3d::Zero(), -1.0);
  return residual;
}

JointSolution adjust_jointly(const JointProblem& problem) {
  return JointSolver(problem).run();
}

}  // namespace limen
