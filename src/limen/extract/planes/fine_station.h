// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/extract/cells/morton_order.h"
#include "limen/extract/planes/fine_planes.h"
#include "limen/extract/planes/grow_planes.h"

namespace limen {

/// Planes of a station as finely as its noise tells them apart. Those of `grown` were found at a threshold of
/// about three times the noise, in cubes: they hold neighbours that stand a few millimetres before or behind,
/// and take the edges of boards from the planes across.
/// 1. What no plane holds is looked through for the relief of walls (relief_sheets.h): edges of shelves,
/// sills.
/// 2. Planes come apart at steps (split_at_steps.h), parts of one plane are put together (join_pieces.h).
/// 3. Points choose their planes anew (coherent_labels.h); what cuts along the edge of others is given back.
/// `order`: of the ground that they grew in.
PlaneLabels fine_station_planes(const Scan& scan, const MortonOrder& order, const GrownPlanes& grown,
                                const FineOptions& options);

}  // namespace limen
