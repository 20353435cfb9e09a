// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "limen/geometry/rigid.h"

namespace limen {

/// A point whose coordinates a surveyor gives.
struct SurveyedPoint {
  std::string name;
  Vector3d x = Vector3d::Zero();               ///< metres
  Matrix3d covariance = Matrix3d::Identity();  ///< m^2
};

/// Where a scan saw a target.
struct SeenTarget {
  std::string name;
  std::string scan;                       ///< its file, as the user writes it; " #2" for one of several
  Vector3d x_in_scan = Vector3d::Zero();  ///< metres, the scan's own coordinates as they stand in its file
  Matrix3d covariance = Matrix3d::Identity();  ///< m^2, the scan's axes
  std::optional<double> time_s;                ///< of a mobile scan: when it saw it, as its points' times are
};

/// Text with a header line that names its columns, between commas, semicolons or tabs: name, x, y, z (metres)
/// and sigma, or sigma_x, sigma_y, sigma_z (metres), or cov_xx, cov_xy, cov_xz, cov_yy, cov_yz, cov_zz
/// (square metres). Between semicolons a comma may stand for the decimal point. Every digit is kept.
/// Throws Error that names the file, the line and what can be done: a column is missing, a number is none, a
/// deviation is not positive, a name occurs twice.
std::vector<SurveyedPoint> read_surveyed_points(const std::filesystem::path& path);

/// The same with a column `scan`, and perhaps `time` (seconds); a target may be seen by many scans, by each
/// of them once at a time.
std::vector<SeenTarget> read_seen_targets(const std::filesystem::path& path);

/// Approximate scanner positions: a table of points with a column `file`, which names the scan, in place of
/// `name`. Without a column of deviations these are 1 m.
std::vector<SurveyedPoint> read_stated_positions(const std::filesystem::path& path);

}  // namespace limen
