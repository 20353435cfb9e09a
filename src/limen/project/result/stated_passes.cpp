// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/result/stated_passes.h"

namespace limen {
namespace {

/// Deviations along the axes of the result's frame.
Vector3d sigma_in(const Matrix3d& stated_from_solved, const Matrix3d& covariance) {
  const Matrix3d stated = stated_from_solved * covariance * stated_from_solved.transpose();
  return stated.diagonal().cwiseMax(0.0).cwiseSqrt();
}

}  // namespace

std::string why_rigid(const ScanDigest& digest) {
  if (digest.track.way.known()) return "its drift was not estimated";
  return "its points have no times, or its path is short: it is treated as rigid";
}

PassCorrection stated_correction(const BentPass& pass, const PassWay& way, const Rigid3& stated_from_solved,
                                 const Vector3d& origin) {
  const Matrix3d& turn = stated_from_solved.rotation;
  const Vector3d pivot = stated_from_solved * pass.frame_from_node.translation;
  PassCorrection correction;
  correction.pivot = pivot + origin;
  correction.shift_rate_m2_per_m = pass.shift_rate_m2_per_m;
  correction.turn_rate_rad2_per_m = pass.turn_rate_rad2_per_m;
  for (std::size_t k = 0; k < pass.knots.size(); ++k) {
    const BentKnot& bent = pass.knots[k];
    const Vector3d given = stated_from_solved * (pass.frame_from_node * way.places[k]);
    PassKnot knot;
    knot.time_s = way.times_s[k];
    knot.distance_m = way.distances_m[k];
    knot.turn_rad = turn * bent.value.head<3>();
    knot.shift_m = turn * bent.value.tail<3>();
    const Vector3d place = pivot + rotation_exp(knot.turn_rad) * (given - pivot) + knot.shift_m;
    knot.place = place + origin;
    knot.moved_m = place - given;
    knot.turn_sigma_rad = sigma_in(turn, bent.covariance.topLeftCorner<3, 3>());
    knot.moved_sigma_m = sigma_in(turn, bent.covariance.bottomRightCorner<3, 3>());
    correction.knots.push_back(knot);
  }
  return correction;
}

}  // namespace limen
