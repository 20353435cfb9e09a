// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limen/geometry/plane.h"

namespace limen {

/// Which plane each point of a scan belongs to.
struct PlaneLabels {
  std::vector<PlaneFit> fits;        ///< about the scan's local origin
  std::vector<std::int32_t> labels;  ///< per point: index into fits, or -1
  double inlier_threshold_m = 0.0;   ///< that the detector used
};

/// Indices of the points of each plane: points_of(labels, planes)[k] lists those with label k, ascending.
std::vector<std::vector<std::uint32_t>> points_of(const std::vector<std::int32_t>& labels,
                                                  std::size_t planes);

}  // namespace limen
