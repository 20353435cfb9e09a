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
    seen_from_.resize(problem.frame_from_node.size());
    for (std::size_t k = 0; k < problem.observations.size(); ++k) {
      seen_by_[static_cast<std::size_t>(problem.observations[k].plane)].push_back(k);
      seen_from_[static_cast<std::size_t>(problem.observations[k].node)].push_back(k);
    }
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
    residuals_.resize(problem_.observations.size());
    parallel_for(problem_.observations.size(), kAtOnce, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        const PlaneObservation& seen = problem_.observations[k];
        residuals_[k] =
            plane_residual(factors_[k], pose(seen.node), planes_[static_cast<std::size_t>(seen.plane)]);
        const double mean =
            residuals_[k].value.squaredNorm() / std::min(seen.moments.count, seen.most_points);
        const double ratio = kMissed / (kMissed + mean);
        solution_.weights[k] = ratio * ratio;
      }
    });
  }

  void build() {
    system_.clear();
    for (std::size_t e = 0; e < problem_.edges.size(); ++e)
      add_edge(problem_.edges[e], solution_.frame_from_node, information_[e], system_);
    add_nodes();
    add_planes();
    for (const MarkedPoint& point : problem_.points) add_point(point);
    system_.factor();
  }

  double move() {
    build();
    return system_.move(solution_.frame_from_node);
  }

  /// What a plane that two see or more says of their poses, the plane itself eliminated: less
  /// by_place * inverted * by_place^T for each two places of freedoms.
  struct PlaneTerms {
    std::map<int, Wide> by_place;  // many parts of a pass may see one plane
    Matrix3d inverted = Matrix3d::Zero();
    Vector3d right = Vector3d::Zero();
  };

  [[nodiscard]] double weight_of(std::size_t k) const { return plane_share_ * solution_.weights[k]; }
  [[nodiscard]] bool is_shared(std::size_t plane) const { return seen_by_[plane].size() >= 2; }

  /// Adds what the observations say as if the planes were known.
  void add_nodes() {
    std::vector<Matrix6d> blocks(solution_.frame_from_node.size(), Matrix6d::Zero());
    std::vector<Vector6d> rights(blocks.size(), Vector6d::Zero());
    parallel_for(blocks.size(), 1, [&](std::size_t node, std::size_t /*end*/) {
      for (const std::size_t k : seen_from_[node]) {
        if (!is_shared(static_cast<std::size_t>(problem_.observations[k].plane))) continue;
        const PlaneResidual& residual = residuals_[k];
        const Eigen::Matrix<double, 6, 4> weighted = weight_of(k) * residual.by_pose.transpose();
        blocks[node].noalias() += weighted * residual.by_pose;
        rights[node].noalias() -= weighted * residual.value;
      }
    });
    for (std::size_t k = 0; k < blocks.size(); ++k) {
      if (seen_from_[k].empty()) continue;
      system_.add(static_cast<int>(k), static_cast<int>(k), blocks[k]);
      system_.add_right(static_cast<int>(k), rights[k]);
    }
  }

  /// Takes off what is due to the planes being unknown.
  void add_planes() {
    std::vector<PlaneTerms> terms(seen_by_.size());
    parallel_for(terms.size(), kAtOnce, [&](std::size_t begin, std::size_t end) {
      for (std::size_t p = begin; p < end; ++p) terms[p] = terms_of(p);
    });
    std::vector<std::vector<std::size_t>> planes_of(static_cast<std::size_t>(system_.moving()));
    for (std::size_t p = 0; p < terms.size(); ++p) {
      for (const auto& [place, wide] : terms[p].by_place)
        planes_of[static_cast<std::size_t>(place)].push_back(p);
    }
    parallel_for(planes_of.size(), 1, [&](std::size_t column, std::size_t /*end*/) {
      const int place = static_cast<int>(column);
      for (const std::size_t p : planes_of[column]) {
        const std::map<int, Wide>& by_place = terms[p].by_place;
        const auto own = by_place.find(place);
        const Wide half = own->second * terms[p].inverted;
        system_.add_right_at(place, -half * terms[p].right);
        for (auto row = own; row != by_place.end(); ++row)
          system_.add_at(row->first, place, -row->second * half.transpose());
      }
    });
  }

  [[nodiscard]] PlaneTerms terms_of(std::size_t p) const {
    PlaneTerms terms;
    if (!is_shared(p)) return terms;
    Matrix3d own = kTinyInformation * Matrix3d::Identity();
    for (const std::size_t k : seen_by_[p]) {
      const PlaneResidual& residual = residuals_[k];
      const double weight = weight_of(k);
      own += weight * residual.by_plane.transpose() * residual.by_plane;
      terms.right -= weight * residual.by_plane.transpose() * residual.value;
      const Wide mixed = weight * residual.by_pose.transpose() * residual.by_plane;
      for (const auto& [place, share] : system_.shares(problem_.observations[k].node))
        terms.by_place.try_emplace(place, Wide::Zero()).first->second += share * mixed;
    }
    terms.inverted = inverse_of(own);
    return terms;
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
      if (!is_shared(plane)) continue;
      // What a plane's own thickness leaves is no contradiction between scans.
      sum += solution_.weights[k] * (residuals_[k].value.squaredNorm() - own_misfit(seen));
      count += 3.0 * solution_.weights[k];
    }
    for (std::size_t p = 0; p < seen_by_.size(); ++p) count -= is_shared(p) ? 3.0 : 0.0;
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
    system_.invert();
    solution_.edge_covariance.assign(problem_.edges.size(), Matrix6d::Zero());
    for (std::size_t e = 0; e < problem_.edges.size(); ++e) {
      const PoseEdge& edge = problem_.edges[e];
      if (!edge.stated) continue;
      CancelScope::check();
      solution_.edge_covariance[e] = covariance_of_edge(edge, pose(edge.source), pose(edge.target), system_);
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
  std::vector<PlaneResidual> residuals_;
  std::vector<std::vector<std::size_t>> seen_by_;    ///< of a plane
  std::vector<std::vector<std::size_t>> seen_from_;  ///< of a node
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
