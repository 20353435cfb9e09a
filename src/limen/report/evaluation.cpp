// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/evaluation.h"

#include <algorithm>
#include <cmath>

namespace limen {
namespace {

/// The worst of the six errors, each in its own standard deviations; nothing where one of these is not known.
std::optional<double> largest_sigmas(const PoseSigma& sigma, const Vector3d& rotation_error,
                                     const Vector3d& shift_at_centre) {
  double largest = 0.0;
  for (Eigen::Index i = 0; i < 3; ++i) {
    if (!(sigma.rotation_rad[i] > 0.0) || !(sigma.translation_m[i] > 0.0)) return std::nullopt;
    largest = std::max({largest, std::abs(rotation_error[i]) / sigma.rotation_rad[i],
                        std::abs(shift_at_centre[i]) / sigma.translation_m[i]});
  }
  return largest;
}

}  // namespace

PoseError compare_poses(const PoseFile& result, const Rigid3& true_target_from_source) {
  const Rigid3& found = *result.target_from_source;
  const Matrix3d turn = found.rotation * true_target_from_source.rotation.transpose();
  PoseError error;
  error.rotation_vector_rad = rotation_log(turn);
  error.rotation_rad = error.rotation_vector_rad.norm();
  error.measured_at = result.source_middle.value_or(Vector3d::Zero());
  error.shift_m = found * error.measured_at - true_target_from_source * error.measured_at;
  error.translation_m = error.shift_m.norm();
  if (result.sigma) {
    const Vector3d centre_in_source = inverse(true_target_from_source) * result.sigma->centre;
    const Vector3d shift = found * centre_in_source - true_target_from_source * centre_in_source;
    error.largest_sigmas = largest_sigmas(*result.sigma, error.rotation_vector_rad, shift);
  }
  return error;
}

}  // namespace limen
