// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "limen/model/features.h"
#include "limen/model/scan.h"

namespace limen {

/// A small piece of what is in a room. Of a flat one (the side of a chair, a monitor, a cupboard's door)
/// the points fix where it is across to the noise over the root of their number: millimetres.
struct SurfaceDetail {
  Vector3d mean = Vector3d::Zero();    ///< metres, about the scan's local origin
  Vector3d normal = Vector3d::Zero();  ///< towards the scanner where that is known; zero: not flat
  float area_m2 = 0.0F;
  /// Of the mean across a flat piece: scatter of its points over the root of their number.
  float sigma_m = 0.0F;

  [[nodiscard]] bool flat() const { return !normal.isZero(); }
};

/// Whether a plane is the building's by its size: walls, even a strip of one between two windows, are longer
/// than furniture is high. A table or a bed that is taken for a wall is evidence lost, not evidence forged.
bool of_building(const PlanarPolygon& plane);

/// The pieces that the points of a scan make that lie on no plane of the building. `labels[i]` is the plane
/// of point i, or -1. Across a flat piece its points scatter by up to `max_scatter_m`; edges and rounder
/// things are not flat.
std::vector<SurfaceDetail> find_surface_details(const Scan& scan, const std::vector<std::int32_t>& labels,
                                                const std::vector<PlanarPolygon>& planes,
                                                double max_scatter_m = 0.005);

}  // namespace limen
