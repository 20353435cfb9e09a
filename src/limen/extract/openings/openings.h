// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "limen/base/progress.h"
#include "limen/extract/features/extract_features.h"
#include "limen/extract/surface/facades.h"
#include "limen/model/features.h"
#include "limen/model/scan.h"

namespace limen {

/// Which openings are looked for.
struct OpeningOptions {
  FacadeCriteria walls = {radians(3.0), 0.8, 1.0, 0.3};  ///< in what openings are looked for
  double min_wall_m = 2.2;         ///< height of a wall, all its planes together; furniture is lower; >= 0
  double min_depth_m = 0.03;       ///< points at least this far behind the wall lie in an opening; > 0
  double through_m = 0.6;          ///< farther behind they lie beyond it: view through; > min_depth_m
  double min_width_m = 0.35;       ///< of an opening; > 0
  double min_height_m = 0.35;      ///< of an opening; > 0
  double max_width_m = 6.0;        ///< of an opening; > min_width_m
  double max_height_m = 6.0;       ///< of an opening; > min_height_m
  std::optional<Vector3d> centre;  ///< scanner position, about the local origin, where the scan has none

  void check() const;
};

/// Windows and doors of a scan as upright rectangles in its walls (2022, sections 2.2 and 2.3), wall by wall,
/// each wall's from left to right. `extracted`: the scan's own features and labels; Opening::facade is an
/// index into extracted.features.planes. `up`: unit vector against gravity in the scan's frame. Throws Error
/// where the scanner position is known neither from the scan nor from the options.
std::vector<Opening> find_openings(const Scan& scan, const ExtractedFeatures& extracted, const Vector3d& up,
                                   const OpeningOptions& options = {}, Monitor& monitor = silent_monitor());

}  // namespace limen
