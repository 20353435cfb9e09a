// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/judge/verdict.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "limen/base/angles.h"
#include "limen/base/error.h"
#include "limen/geometry/linear.h"
#include "limen/register/judge/evidence_table.h"

namespace limen {
namespace {

bool same_pose(const RefinedPose& a, const RefinedPose& b, const VerdictOptions& options) {
  const Matrix3d turn = a.target_from_source.rotation.transpose() * b.target_from_source.rotation;
  if (rotation_angle(turn) > radians(options.same_rotation_deg)) return false;
  // Where both poses put the middle of the surface matched by the first.
  const Vector3d middle = inverse(a.target_from_source) * a.centre;
  return (b.target_from_source * middle - a.centre).norm() <= options.same_shift_m;
}

/// Whether two poses differ only along shifts that the first leaves open.
bool same_but_for(const RefinedPose& a, const RefinedPose& b, const std::vector<UnobservedFreedom>& open,
                  const VerdictOptions& options) {
  const Matrix3d turn = a.target_from_source.rotation.transpose() * b.target_from_source.rotation;
  if (rotation_angle(turn) > radians(options.same_rotation_deg)) return false;
  const Vector3d middle = inverse(a.target_from_source) * a.centre;
  Vector3d shift = b.target_from_source * middle - a.centre;
  for (const UnobservedFreedom& freedom : open) shift -= freedom.direction.dot(shift) * freedom.direction;
  return shift.norm() <= options.same_shift_m;
}

std::string direction_name(const Vector3d& d) {
  if (std::abs(d.z()) > 0.996) return "the vertical";
  return fmt::format("({:.2f}, {:.2f}, {:.2f})", d.x(), d.y(), d.z());
}

/// The direction with its largest part positive: a freedom has no sign.
Vector3d positive(const Vector3d& d) {
  Eigen::Index largest = 0;
  d.cwiseAbs().maxCoeff(&largest);
  return d[largest] < 0 ? Vector3d(-d) : d;
}

/// Directions in which a 3 x 3 information (m^2) is below the bound.
void add_weak(const Matrix3d& information, double bound, bool rotation,
              std::vector<UnobservedFreedom>& weak) {
  const Spectrum3 spectrum = spectrum_of(information);
  for (Eigen::Index k = 0; k < 3; ++k) {
    if (spectrum.values[k] >= bound) continue;
    const Vector3d d = positive(spectrum.vectors.col(k));
    weak.push_back({rotation, d, (rotation ? "turn about " : "shift along ") + direction_name(d)});
  }
}

}  // namespace

void VerdictOptions::check() const {
  if (!(risk > 0 && risk < 0.5)) throw_bad_option("risk", risk, "within (0, 0.5)");
  if (!(probable_risk > risk && probable_risk < 0.5))
    throw_bad_option("probable_risk", probable_risk, fmt::format("within ({:g}, 0.5), above the risk", risk));
  const std::pair<const char*, double> bounds[] = {
      {"max_sigma_m", max_sigma_m},       {"max_sigma_deg", max_sigma_deg},
      {"max_drifting_m", max_drifting_m}, {"max_drifting_deg", max_drifting_deg},
      {"min_held_m2", min_held_m2},       {"same_rotation_deg", same_rotation_deg},
      {"same_shift_m", same_shift_m}};
  for (const auto& [name, value] : bounds) {
    if (!(value > 0)) throw_bad_option(name, value, "more than 0");
  }
}

std::vector<UnobservedFreedom> unobserved_freedoms(const RefinedPose& pose, double min_held_m2) {
  const Matrix3d turns = pose.geometry_m2.topLeftCorner<3, 3>();
  const Matrix3d shifts = pose.geometry_m2.bottomRightCorner<3, 3>();
  const Matrix3d mixed = pose.geometry_m2.topRightCorner<3, 3>();
  const Matrix3d damping = 1e-9 * Matrix3d::Identity();
  // What is left of each block once the other is free (Schur complements).
  const Matrix3d shift_held = shifts - mixed.transpose() * (turns + damping).inverse() * mixed;
  const Matrix3d turn_held = turns - mixed * (shifts + damping).inverse() * mixed.transpose();
  std::vector<UnobservedFreedom> weak;
  add_weak(shift_held, min_held_m2, false, weak);
  add_weak(turn_held, 0.25 * min_held_m2, true, weak);
  return weak;
}

std::vector<UnobservedFreedom> loose_freedoms(const Matrix6d& covariance, double max_sigma_m,
                                              double max_sigma_deg) {
  std::vector<UnobservedFreedom> loose;
  const Spectrum3 shifts = spectrum_of(Matrix3d(covariance.bottomRightCorner<3, 3>()));
  const Spectrum3 turns = spectrum_of(Matrix3d(covariance.topLeftCorner<3, 3>()));
  for (Eigen::Index k = 0; k < 3; ++k) {
    const double sigma_m = std::sqrt(std::max(0.0, shifts.values[k]));
    const double sigma_deg = degrees(std::sqrt(std::max(0.0, turns.values[k])));
    const Vector3d along = positive(shifts.vectors.col(k));
    const Vector3d about = positive(turns.vectors.col(k));
    if (sigma_m > max_sigma_m) {
      loose.push_back({false, along,
                       fmt::format("shift along {} (sigma {:.0f} mm)", direction_name(along),
                                   1e3 * std::min(sigma_m, 10.0))});
    }
    if (sigma_deg > max_sigma_deg) {
      loose.push_back({true, about,
                       fmt::format("turn about {} (sigma {:.2f} deg)", direction_name(about),
                                   std::min(sigma_deg, 180.0))});
    }
  }
  return loose;
}

std::vector<std::size_t> rank(const std::vector<FoundPose>& poses, const VerdictOptions& options) {
  const auto value_of = [&](std::size_t i) {
    return poses[i].score.value() + poses[i].log_prior / evidence_table::kRooms.nats_per_m2;
  };
  std::vector<std::size_t> order(poses.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return value_of(a) > value_of(b); });
  std::vector<std::size_t> distinct;
  for (const std::size_t i : order) {
    const bool known = std::any_of(distinct.begin(), distinct.end(), [&](std::size_t j) {
      return same_pose(poses[j].refined, poses[i].refined, options);
    });
    if (!known) distinct.push_back(i);
  }
  return distinct;
}

OpenFreedoms open_freedoms(const RefinedPose& pose, const Matrix6d& with_drift,
                           const VerdictOptions& options) {
  OpenFreedoms open{unobserved_freedoms(pose, options.min_held_m2)};
  if (open.list.empty())
    open.list = loose_freedoms(covariance_of(pose), options.max_sigma_m, options.max_sigma_deg);
  if (!open.list.empty()) return open;
  for (const OpenFreedoms::Cause cause : {OpenFreedoms::Cause::drift, OpenFreedoms::Cause::moved}) {
    const Matrix6d covariance =
        cause == OpenFreedoms::Cause::moved ? Matrix6d(with_drift + pose.spread) : with_drift;
    open.list = loose_freedoms(covariance, options.max_drifting_m, options.max_drifting_deg);
    if (open.list.empty()) continue;
    open.cause = cause;
    return open;
  }
  return open;
}

bool is_slid(const RefinedPose& first, const RefinedPose& second, const VerdictOptions& options) {
  const std::vector<UnobservedFreedom> open = unobserved_freedoms(first, options.min_held_m2);
  return !open.empty() && same_but_for(first, second, open, options);
}

}  // namespace limen
