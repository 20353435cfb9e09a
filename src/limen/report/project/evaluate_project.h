// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "limen/report/pose_file.h"
#include "limen/report/project/read_project.h"

namespace limen {

/// How far a registered scan is from where it should be, against the project's reference.
struct PlaceError {
  std::string file;
  double shift_m = 0.0;  ///< at its scanner; of a pass, in the middle of all stations
  double turn_rad = 0.0;
};

struct ProjectErrors {
  std::size_t scans = 0;         ///< of the project, models and copies not counted
  std::vector<PlaceError> each;  ///< of those registered, in the project's order, the reference too
  std::size_t reference = 0;     ///< which of them: that against which the others err least (the median)

  /// Metres; 0 where nothing but the reference is registered. `share`: 0.5 for the median.
  [[nodiscard]] double shift_of(double share) const;
};

/// Holds the places of all `registered` scans against the truth. A project's frame is its own: all are
/// compared as they stand to one of them. A scan's truth is that of its file's name; where several are called
/// alike by their folders, as many as both paths end with. Throws Error, which names `truth_path`, where
/// the truth lacks a scan or cannot be distinguished from another's.
ProjectErrors evaluate_project(const std::vector<ProjectEntry>& project, const std::vector<TrueScan>& truth,
                               const std::filesystem::path& truth_path);

/// Of values the one below which a share of them lies; 0 of none.
double quantile(std::vector<double> values, double share);

}  // namespace limen
