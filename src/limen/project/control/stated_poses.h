// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "limen/geometry/rigid.h"

namespace limen {

/// Where a scan is said to have been taken: by satellites, by a tablet's track, by another program.
struct StatedPose {
  std::string scan;               ///< its file, as the user writes it; " #2" for one of several
  Vector3d x = Vector3d::Zero();  ///< of the scanner, or with a quaternion of the file's 0,0,0; metres
  Matrix3d covariance = Matrix3d::Identity();  ///< m^2
  std::optional<Matrix3d> frame_from_scan;     ///< rotation, where it is known
  bool of_origin = false;                      ///< `x` is of the file's 0,0,0
  double sigma_rad = 0.0;                      ///< of the rotation, per axis
};

/// A table like control points (control/control_file.h) with a column `file` in place of `name`. Without a
/// column of deviations they are 1 m. `heading`: degrees clockwise, from the frame's y axis to the scan's;
/// `qw`, `qx`, `qy`, `qz`: the rotation of the scan into the frame; `sigma_deg`: of either, 5 without. Throws
/// Error that names the file, the line and what can be done.
std::vector<StatedPose> read_stated_poses(const std::filesystem::path& path);

}  // namespace limen
