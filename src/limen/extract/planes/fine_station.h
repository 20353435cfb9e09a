// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limen/extract/cells/morton_order.h"
#include "limen/extract/planes/fine_planes.h"
#include "limen/extract/planes/grow_planes.h"
#include "limen/extract/planes/settle_planes.h"

namespace limen {

struct CoherentOptions {
  double threshold_m = 0.01;  ///< farthest a point may lie from its plane
  double noise_m = 0.003;     ///< of a point about its plane, one standard deviation
};

/// Every point goes to the plane that is likeliest to have been met there: by its distance, in noises, and by
/// how many points around chose it before. With distances alone a quarter of the points between a mullion and
/// its frame, 4 mm apart at 3 mm noise, would take the wrong one. One round: the choices around are those
/// before the call. `sums`, of the planes' points about the curve's anchor, follows. A plane's label is its
/// place in `sums`; a point that no plane explains has -1.
void coherent_labels(const SettleScene& scene, const CoherentOptions& options,
                     std::vector<std::int32_t>& labels, std::vector<PointMoments>& sums);

/// Planes of a station as finely as its noise allows. Those of `grown` were found at a threshold of
/// about three times the noise, in cubes: they hold neighbours that stand a few millimetres before or behind,
/// and take the edges of boards from the planes across.
/// 1. What no plane holds is looked through for the relief of walls (relief_sheets.h): edges of shelves,
/// sills.
/// 2. Planes are cut at steps (split_at_steps.h), parts of one plane are put together (join_pieces.h).
/// 3. Points choose their planes anew (coherent_labels above); what cuts along the edge of others is given
/// back. `order`: of the ground that they grew in.
PlaneLabels fine_station_planes(const Scan& scan, const MortonOrder& order, const GrownPlanes& grown,
                                const FineOptions& options);

}  // namespace limen
