// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/summary/precision.h"

#include <algorithm>
#include <cmath>

namespace limen {
namespace {

constexpr double kNormal95 = 1.6448536269514722;  // one-sided
constexpr double kLargeM = 1e5;                   // single precision keeps less than 8 mm there

/// Quantile 0.95 of `freedoms` times an F distribution's variable, of chi-square where `known_by` is large
/// (Paulson 1942, Wilson and Hilferty 1931).
double quantile_95(double freedoms, double known_by) {
  const double a = 2.0 / (9.0 * freedoms);
  const double b = 2.0 / (9.0 * known_by);
  const double z2 = kNormal95 * kNormal95;
  const double root = std::sqrt(a * (1.0 - b) * (1.0 - b) + b * (1.0 - a) * (1.0 - a) - a * b * z2);
  return freedoms *
         std::pow(((1.0 - a) * (1.0 - b) + kNormal95 * root) / ((1.0 - b) * (1.0 - b) - z2 * b), 3);
}

/// Covariance of the displacement of a point `lever` away from the centre of `covariance`.
Matrix3d displacement_covariance(const Matrix6d& covariance, const Vector3d& lever,
                                 const std::vector<UnobservedFreedom>& open) {
  Eigen::Matrix<double, 3, 6> turn_and_shift;
  turn_and_shift << 0, lever.z(), -lever.y(), 1, 0, 0,  //
      -lever.z(), 0, lever.x(), 0, 1, 0,                //
      lever.y(), -lever.x(), 0, 0, 0, 1;
  Matrix3d moved = turn_and_shift * covariance * turn_and_shift.transpose();
  for (const UnobservedFreedom& freedom : open) {
    const Matrix3d across = Matrix3d::Identity() - freedom.direction * freedom.direction.transpose();
    moved = across * moved * across;
  }
  return moved;
}

PlacePrecision precision_at(const Vector3d& at, const PoseSigma& sigma, double known_by,
                            const std::vector<UnobservedFreedom>& open) {
  const Vector3d lever = at - sigma.centre;
  PlacePrecision place;
  place.at = at;
  place.radius_m = radius_95(displacement_covariance(sigma.covariance, lever, open), known_by);
  if (!sigma.formal_covariance.isZero(0.0))
    place.formal_radius_m = radius_95(displacement_covariance(sigma.formal_covariance, lever, open));
  return place;
}

/// Places of the side whose precision is reported, in the target's world.
struct StatedPlaces {
  Vector3d middle = Vector3d::Zero();
  std::vector<Vector3d> corners;
};

StatedPlaces stated_places(const RegistrationReport& report, const Rigid3& target_from_source) {
  const bool by_target = report.source.kind == "model" && report.target.kind != "model";
  const InputSummary& side = by_target ? report.target : report.source;
  const Rigid3 target_from_side = by_target ? Rigid3{} : target_from_source;
  const bool inner = side.inner_high != side.inner_low;
  const Vector3d& low = inner ? side.inner_low : side.low;
  const Vector3d& high = inner ? side.inner_high : side.high;
  StatedPlaces places;
  places.middle = target_from_side * side.middle;
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3d x((corner & 1) != 0 ? high.x() : low.x(), (corner & 2) != 0 ? high.y() : low.y(),
                     (corner & 4) != 0 ? high.z() : low.z());
    places.corners.push_back(target_from_side * x);
  }
  return places;
}

}  // namespace

double radius_95(const Matrix3d& covariance, double known_by) {
  const double mean = covariance.trace();
  if (!(mean > 0)) return 0.0;
  const double square = (covariance * covariance).trace();
  const double freedoms = std::clamp(mean * mean / square, 1.0, 3.0);
  return std::sqrt(mean / freedoms * quantile_95(freedoms, known_by));
}

double freedoms_of(const std::vector<PlaneMatch>& matches) {
  constexpr double kFewest = 3.0;  // Paulson's approximation holds from there
  double sum = 0.0;
  double squares = 0.0;
  for (const PlaneMatch& match : matches) {
    sum += match.overlap_m2;
    squares += match.overlap_m2 * match.overlap_m2;
  }
  return squares > 0.0 ? std::max(kFewest, sum * sum / squares - 3.0) : 1e9;
}

std::optional<PosePrecision> precision_of(const RegistrationReport& report, const Hypothesis& pose) {
  const RegistrationResult& result = report.result;
  if (result.outcome == Outcome::no_match || result.published || pose.sigma.covariance.isZero(0.0))
    return std::nullopt;
  const std::vector<UnobservedFreedom>& open = result.unobserved;
  if (std::any_of(open.begin(), open.end(), [](const auto& freedom) { return freedom.rotation; }))
    return std::nullopt;
  const StatedPlaces places = stated_places(report, pose.target_from_source);
  const double known_by = freedoms_of(result.matches);
  PosePrecision precision;
  precision.middle = precision_at(places.middle, pose.sigma, known_by, open);
  for (const Vector3d& corner : places.corners) {
    const PlacePrecision there = precision_at(corner, pose.sigma, known_by, open);
    if (there.radius_m > precision.far_end.radius_m) precision.far_end = there;
  }
  precision.far_distance_m = (precision.far_end.at - precision.middle.at).norm();
  precision.across_open = !open.empty();
  return precision;
}

PoseMotion motion_of(const RegistrationReport& report, const Hypothesis& pose) {
  PoseMotion motion;
  motion.about = report.source.middle;
  motion.shift_m = pose.target_from_source * motion.about - motion.about;
  const Vector3d turn = rotation_log(pose.target_from_source.rotation);
  motion.turn_rad = turn.norm();
  if (motion.turn_rad > 0) motion.axis = turn / motion.turn_rad;
  return motion;
}

Vector3d shift_sigma_of(const RegistrationReport& report, const Hypothesis& pose) {
  const Vector3d lever = pose.target_from_source * report.source.middle - pose.sigma.centre;
  return displacement_covariance(pose.sigma.covariance, lever, {}).diagonal().cwiseMax(0.0).cwiseSqrt();
}

std::optional<double> plane_distance_rms(const std::vector<PlaneMatch>& matches) {
  double squares = 0.0;
  double areas = 0.0;
  for (const PlaneMatch& match : matches) {
    squares += match.overlap_m2 * match.distance_m * match.distance_m;
    areas += match.overlap_m2;
  }
  if (!(areas > 0)) return std::nullopt;
  return std::sqrt(squares / areas);
}

bool on_large_coordinates(const RegistrationReport& report) {
  const auto large = [](const InputSummary& side) { return side.middle.cwiseAbs().maxCoeff() > kLargeM; };
  return large(report.source) || large(report.target);
}

}  // namespace limen
