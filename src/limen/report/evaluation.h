// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "limen/report/pose_file.h"

namespace limen {

/// How far a pose is from the true one.
struct PoseError {
  double rotation_rad = 0.0;             ///< angle of the rotation between the two
  double translation_m = 0.0;            ///< how far `measured_at` lands from where it should
  Vector3d measured_at;                  ///< a point of the source's frame, metres
  Vector3d rotation_vector_rad;          ///< the rotation error about x, y, z of the target frame
  Vector3d shift_m;                      ///< the translation error along x, y, z of the target frame
  std::optional<double> largest_sigmas;  ///< the worst of the six errors in its standard deviations
};

/// Compares `result.target_from_source` (which must be there) with the truth. The translation error is taken
/// at the middle of the source's extent where that is known, else at
/// the origin of the source's frame.
PoseError compare_poses(const PoseFile& result, const Rigid3& true_target_from_source);

}  // namespace limen
