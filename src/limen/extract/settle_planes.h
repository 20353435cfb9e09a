// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limen/extract/point_normals.h"
#include "limen/geometry/plane.h"

namespace limen {

struct SettleOptions {
  double threshold_m = 0.01;      ///< farthest a point may lie from its plane
  double cell_m = 0.08;           ///< a point may join the planes of its cube and of the cubes around it
  double max_angle_deg = 20.0;    ///< between a plane and the surface at a point
  std::uint32_t min_support = 4;  ///< points of a plane in a cube that make it a candidate there
};

/// Every point goes to the nearest plane around it that the surface there faces along with; a point that has
/// none of these goes free. `labels[k]` is the plane of the k-th point along the curve, or -1; `sums` those
/// of the planes' points, about the curve's anchor. Cubes of few points (far from the scanner) keep their
/// labels.
std::vector<std::int32_t> settled(const MortonOrder& sorted, const PointNormals& normals,
                                  const std::vector<std::int32_t>& labels,
                                  const std::vector<PointMoments>& sums, const SettleOptions& options);

/// Of each plane's points the share that larger planes around would take: near 1 for a plane that cuts
/// through the edges of others.
std::vector<double> explained_shares(const MortonOrder& sorted, const PointNormals& normals,
                                     const std::vector<std::int32_t>& labels,
                                     const std::vector<PointMoments>& sums, const SettleOptions& options);

}  // namespace limen
