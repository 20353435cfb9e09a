// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/extract/cells/morton_order.h"
#include "limen/extract/planes/plane_labels.h"
#include "limen/model/scan.h"

namespace limen {

struct FineStationOptions {
  double noise_m = 0.003;  ///< of a point about its plane, one standard deviation
  double drift_m = 0.001;  ///< by which parts of one surface may stray beside the noise
  int min_inliers = 200;   ///< smallest plane, points

  void check() const;
};

/// Planes of a station as finely as its noise tells them apart. `planes` were found at a threshold of about
/// three times the noise, in cubes: they hold neighbours that stand a few millimetres before or behind, and
/// take the edges of boards from the planes across.
/// 1. What no plane holds is looked through for the relief of walls (relief_sheets.h): edges of shelves,
/// sills.
/// 2. Planes come apart at steps (split_at_steps.h), parts of one plane are put together (join_pieces.h).
/// 3. Points choose their planes anew (coherent_labels.h); what cuts along the edge of others is given back.
/// `order`: the scan's points along a curve.
PlaneLabels fine_station_planes(const Scan& scan, const MortonOrder& order, const PlaneLabels& planes,
                                const FineStationOptions& options);

}  // namespace limen
