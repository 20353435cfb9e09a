// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/extract/openings/opening_rectangles.h"

namespace limen {

/// The outline of an opening that is clearly no rectangle.
struct OpeningOutline {
  Ring ring;           ///< in the wall's frame, counter-clockwise; empty: a rectangle describes it
  Box2 box;            ///< its upright rectangle
  bool round = false;  ///< bent all round, not only at the head
};

/// Looks at the corners of a rectangle: where wall fills two of them (an arch) or all four (a round window)
/// the outline is followed all round, direction by direction from the middle, each time to where open samples
/// and wall part best.
OpeningOutline find_outline(const WallEvidence& evidence, const OpeningGrid& grid,
                            const OpeningRectangle& rectangle);

}  // namespace limen
