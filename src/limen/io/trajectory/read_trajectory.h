// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "limen/io/trajectory/trajectory.h"

namespace limen {

struct TrajectoryOptions {
  /// Of a text, in their order: time, x, y, z or time, latitude, longitude, height (degrees), and where the
  /// lever arm is wanted roll, pitch, heading (degrees); any other name is passed over. Empty: as a header
  /// line says.
  std::vector<std::string> columns;
  /// Geographic places become easting, northing, height of "32N" or another UTM zone, of the zone of the
  /// first place ("auto"), of any system of a map ("EPSG:2154", WKT: by PROJ), or east, north and up about
  /// the first place ("local").
  std::string utm_zone = "auto";
  double time_offset_s = 0.0;  ///< added to the times of the file
  double max_gap_s = 1.0;      ///< places are not interpolated across longer gaps
  /// From the trajectory's point to the scanner position, in the body's frame: forward, right, down, metres.
  Vector3d lever_arm_m = Vector3d::Zero();

  /// What is between the dashes and the names of these options in messages, as "source-".
  std::string option_side;

  void check() const;
};

/// Reads a trajectory: SBET (records of 17 numbers: time in seconds of the GPS week, latitude, longitude,
/// height above the ellipsoid, speeds, roll, pitch, platform heading and wander angle in radians, ...), or
/// text with one place per line. Throws Error that names the file, the place and what can be done.
Trajectory read_trajectory(const std::filesystem::path& path, const TrajectoryOptions& options = {});

}  // namespace limen
