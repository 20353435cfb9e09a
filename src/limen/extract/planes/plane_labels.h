// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limen/extract/cells/morton_order.h"
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

/// Moments of each plane's points about the curve's anchor; `labels[k]` is the plane of the k-th point along
/// the curve, or -1. The same for any number of threads.
std::vector<PointMoments> label_sums(const MortonOrder& order, const std::vector<std::int32_t>& labels,
                                     std::size_t planes);

/// The planes of such labels and sums that have at least `least` points, most points first, and the plane of
/// each point of the scan. `inlier_threshold_m` is left to the caller.
PlaneLabels planes_by_scan(const MortonOrder& order, const std::vector<std::int32_t>& labels,
                           const std::vector<PointMoments>& sums, double least = 0.0);

}  // namespace limen
