// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/planes/straight_scan.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "limen/base/drawn_steps.h"
#include "limen/extract/planes/grow_planes.h"
#include "limen/geometry/linear.h"

namespace limen {
namespace {

constexpr int kDriftRounds = 6;
// The planes that show the drift.
constexpr double kDriftPlaneM = 0.025;  // threshold
constexpr int kFewestInliers = 100;
constexpr double kDriftPlaneWidthM = 2.5;  // the narrower side
constexpr double kDriftNoiseM = 0.005;     // of a point about its plane, relief and all
constexpr double kPointsPerLook = 50.0;    // so many points err alike
constexpr std::size_t kMostDriftPoints = 150000;
// A trajectory's error is given at knots at this distance.
constexpr double kKnotS = 1.0;
constexpr int kMostKnots = 100;
constexpr double kDriftChangeM = 0.003;  // from knot to knot, one standard deviation
constexpr double kDriftStrayM = 0.03;    // in all
constexpr double kLeastDriftM = 0.0015;  // drifts below this are left alone

/// The knots before and after a time, and how far it is from one to the other.
struct KnotPlace {
  std::size_t knot = 0;
  double share = 0.0;
};

KnotPlace knot_place(const ScanDrift& drift, double time_s) {
  const double last = static_cast<double>(drift.knots.size() - 1);
  const double at = std::clamp((time_s - drift.begin_s) / drift.step_s, 0.0, last);
  const auto knot = std::min(drift.knots.size() - 2, static_cast<std::size_t>(at));
  return {knot, at - static_cast<double>(knot)};
}

Scan timed_subset(const Scan& scan, std::size_t most) {
  std::vector<std::uint32_t> kept;
  for_drawn_steps(scan.size(), most, [&](std::size_t i) { kept.push_back(static_cast<std::uint32_t>(i)); });
  return subset(scan, kept);
}

ScanDrift empty_drift(const std::vector<double>& times_s) {
  const auto [first, last] = std::minmax_element(times_s.begin(), times_s.end());
  const double span = *last - *first;
  const int steps = std::clamp(static_cast<int>(span / kKnotS), 2, kMostKnots - 1);
  ScanDrift drift;
  drift.begin_s = *first;
  drift.step_s = std::max(1e-6, span / steps);
  drift.knots.assign(static_cast<std::size_t>(steps) + 1, Vector3d::Zero());
  return drift;
}

/// The equations of the knots: what is known of them beforehand, and the looks at planes.
class DriftEquations {
 public:
  explicit DriftEquations(std::size_t knots)
      : matrix_(Eigen::MatrixXd::Zero(size_of(knots), size_of(knots))),
        right_(Eigen::VectorXd::Zero(size_of(knots))) {
    const double stray = 1.0 / (kDriftStrayM * kDriftStrayM);
    const double change = 1.0 / (kDriftChangeM * kDriftChangeM);
    for (Eigen::Index i = 0; i < matrix_.rows(); ++i) {
      matrix_(i, i) += stray;
      if (i + 3 >= matrix_.rows()) continue;
      matrix_(i, i) += change;
      matrix_(i + 3, i + 3) += change;
      matrix_(i, i + 3) -= change;
      matrix_(i + 3, i) -= change;
    }
  }
  void add(const KnotPlace& place, const Vector3d& normal, double residual, double weight) {
    const std::array<double, 2> shares{1.0 - place.share, place.share};
    for (std::size_t a = 0; a < 2; ++a) {
      const Eigen::Index row = size_of(place.knot + a);
      right_.segment<3>(row) += weight * shares[a] * residual * normal;
      for (std::size_t b = 0; b < 2; ++b)
        matrix_.block<3, 3>(row, size_of(place.knot + b)) +=
            weight * shares[a] * shares[b] * normal * normal.transpose();
    }
  }
  [[nodiscard]] std::vector<Vector3d> solved(std::size_t knots) const {
    const Eigen::VectorXd x = solve_symmetric(matrix_, right_);
    std::vector<Vector3d> solution(knots);
    for (std::size_t k = 0; k < knots; ++k) solution[k] = x.segment<3>(size_of(k));
    return solution;
  }

 private:
  static Eigen::Index size_of(std::size_t knots) { return static_cast<Eigen::Index>(3 * knots); }

  Eigen::MatrixXd matrix_;
  Eigen::VectorXd right_;
};

/// Planes about the straightened points, points far off counting little, and the knots about the planes.
class DriftRounds {
 public:
  DriftRounds(const Scan& scan, const PlaneLabels& planes)
      : scan_(scan), planes_(planes), drift_(empty_drift(scan.times_s)) {
    for (const PlaneFit& fit : planes.fits) fits_.push_back(fit.plane);
  }
  ScanDrift run() {
    for (int round = 0; round < kDriftRounds; ++round) {
      refit_knots();
      refit_planes();
    }
    return drift_;
  }

 private:
  [[nodiscard]] bool holds(std::int32_t label) const {
    return label >= 0 &&
           std::sqrt(12.0 * planes_.fits[static_cast<std::size_t>(label)].variances[1]) >= kDriftPlaneWidthM;
  }
  [[nodiscard]] double trust(double residual) const {
    const double off = residual / kDriftNoiseM;
    return 1.0 / (1.0 + off * off);
  }
  void refit_knots() {
    DriftEquations equations(drift_.knots.size());
    const double look = 1.0 / (kDriftNoiseM * kDriftNoiseM * kPointsPerLook);
    for (std::size_t i = 0; i < scan_.size(); ++i) {
      if (!holds(planes_.labels[i])) continue;
      const Plane& plane = fits_[static_cast<std::size_t>(planes_.labels[i])];
      const double residual = plane.signed_distance(scan_.points[i]);
      const double left = residual - plane.normal.dot(drift_.at(scan_.times_s[i]));
      equations.add(knot_place(drift_, scan_.times_s[i]), plane.normal, residual, look * trust(left));
    }
    drift_.knots = equations.solved(drift_.knots.size());
  }
  void refit_planes() {
    const Vector3d anchor = scan_.points.front();
    std::vector<PointMoments> sums(fits_.size());
    for (std::size_t i = 0; i < scan_.size(); ++i) {
      if (!holds(planes_.labels[i])) continue;
      const auto k = static_cast<std::size_t>(planes_.labels[i]);
      const Vector3d x = scan_.points[i] - drift_.at(scan_.times_s[i]);
      const double weight = trust(fits_[k].signed_distance(x));
      const Vector3d p = x - anchor;
      sums[k].count += weight;
      sums[k].sum += weight * p;
      sums[k].outer += weight * p * p.transpose();
    }
    for (std::size_t k = 0; k < fits_.size(); ++k) {
      if (sums[k].count >= 3.0) fits_[k] = shifted(fit_plane(sums[k]).plane, -anchor);
    }
  }

  const Scan& scan_;
  const PlaneLabels& planes_;
  ScanDrift drift_;
  std::vector<Plane> fits_;
};

}  // namespace

Vector3d ScanDrift::at(double time_s) const {
  if (knots.empty()) return Vector3d::Zero();
  const KnotPlace place = knot_place(*this, time_s);
  return (1.0 - place.share) * knots[place.knot] + place.share * knots[place.knot + 1];
}

ScanDrift scan_drift(const Scan& scan, Monitor& monitor) {
  if (!scan.mobile() || scan.times_s.size() != scan.size()) return {};
  const Scan part = timed_subset(scan, kMostDriftPoints);
  GrowOptions grow;
  grow.inlier_threshold_m = kDriftPlaneM;
  grow.min_inliers = kFewestInliers;
  const PlaneLabels planes = grow_planes(part, grow, monitor).planes;
  const ScanDrift drift = DriftRounds(part, planes).run();
  double squares = 0.0;
  for (const Vector3d& knot : drift.knots) squares += knot.squaredNorm();
  const double stray = std::sqrt(squares / (3.0 * static_cast<double>(drift.knots.size())));
  return stray < kLeastDriftM ? ScanDrift{} : drift;
}

Scan straightened(Scan scan, const ScanDrift& drift) {
  for (std::size_t i = 0; !drift.knots.empty() && i < scan.size(); ++i) {
    const Vector3d error = drift.at(scan.times_s[i]);
    scan.points[i] -= error;
    scan.centres[i] -= error;
  }
  return scan;
}

}  // namespace limen
