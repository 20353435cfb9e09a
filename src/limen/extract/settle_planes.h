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
  double max_angle_deg = 30.0;    ///< between a plane and the surface at a point
  std::uint32_t min_support = 4;  ///< points of a plane in a cube that make it a candidate there
};

/// Every point goes to the nearest plane around it that the surface there faces along with; a point that has
/// none of these goes free. Planes and points about one anchor; `labels[k]` is the plane of the k-th point
/// along the curve, or -1. Cubes of few points (far from the scanner) keep their labels.
std::vector<std::int32_t> settled(const MortonOrder& sorted, const PointNormals& normals,
                                  const std::vector<std::int32_t>& labels, const std::vector<Plane>& planes,
                                  const SettleOptions& options);

}  // namespace limen
