// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "limen/geometry/rigid.h"
#include "limen/geometry/spline_motion.h"
#include "limen/io/crs/coordinate_system.h"
#include "limen/report/project/project_json.h"

namespace limen {

/// A scan as project.json describes it.
struct ProjectEntry {
  std::string file;
  int index = 0;
  bool several = false;  ///< its file holds other scans
  bool model = false;
  std::string state;
  double doubt = 0.0;   ///< probability that it is elsewhere
  std::string sha256;   ///< of the file's bytes
  std::string copy_of;  ///< another file of the same bytes
  /// How well its place is known, the largest of three deviations; of a bent pass along it.
  double sigma_m = 0.0;
  std::optional<Rigid3> frame_from_scan;     ///< empty where it has no place in the project's frame
  std::shared_ptr<const SplineMotion> bend;  ///< of a pass that drifted: what moves it then, by time
  std::vector<double> knot_times_s;          ///< of that
};

/// What the scan is called (project/scan_names.h).
std::string scan_name(const ProjectEntry& entry);

/// The poses that a link of two scans may have, by their numbers.
struct ProjectPoses {
  std::size_t source = 0;  ///< among the scans of read_project()
  std::size_t target = 0;
  std::vector<int> numbers;
};

/// Whether a file is a project.json, by what it holds.
bool is_project(const std::filesystem::path& path);

/// The coordinate system of its frame; not known where it tells none. Throws Error as read_project().
CoordinateSystem read_project_system(const std::filesystem::path& path);

/// The trajectories that its passes were measured along; no files where it tells none. Throws Error as
/// read_project().
StatedTrajectories read_project_trajectories(const std::filesystem::path& path);

/// Of all links whose poses are in the file; that of a link left out as a look-alike place is not. Throws
/// Error as read_project().
std::vector<ProjectPoses> read_project_poses(const std::filesystem::path& path);

/// Its scans and models. Throws Error that names the file and the fault.
std::vector<ProjectEntry> read_project(const std::filesystem::path& path);

}  // namespace limen
