// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/extract/openings/opening_rectangles.h"

namespace limen {

/// Openings behind curtains: where something in folds hangs a little before the wall, with wall seen round it
/// and below, the wall is taken to have an opening. Curtains overhang: the rectangle is the curtain's less a
/// hand's breadth, its sides known to about ten centimetres.
std::vector<OpeningRectangle> curtained_rectangles(const Scan& scan, const WallEvidence& evidence,
                                                   const OpeningGrid& grid, double noise_m,
                                                   const OpeningOptions& options);

}  // namespace limen
