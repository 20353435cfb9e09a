// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/model/features.h"

namespace limen {

struct SampleOptions {
  double tile_m = 0.25;     ///< edge of the tiles of planes
  double clutter_m = 0.25;  ///< edge of the cubes of points in no plane
  bool clutter = true;      ///< whether these are sampled at all

  void check() const;
};

/// Evenly spread pieces of surface: for every plane the means of its points in square tiles, then the means
/// of the other points in cubes. `labels[i]` is the plane of point i, or -1.
std::vector<SurfaceSample> sample_surface(const Scan& scan, const std::vector<std::int32_t>& labels,
                                          const std::vector<PlanarPolygon>& planes,
                                          const SampleOptions& options = {});

}  // namespace limen
