// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "limen/extract/openings/opening_rectangles.h"

namespace limen {

/// How far behind the wall's face that which stands in an opening nearest to it: a frame, a pane or a
/// blind. Before it lie only the opening's own sides, and those reach as far as it does. None where nothing
/// lies within `kMaxFront_m`.
std::optional<double> front_depth(const Scan& scan, const WallEvidence& evidence, const OpeningGrid& grid,
                                  const OpeningRectangle& rectangle);
constexpr double kMaxFront_m = 0.4;

/// Places the sides again by what passed before them on the way to the front: a ray that goes outwards proves
/// more of the wall open than where it met the face.
void narrow_sides(const Scan& scan, const WallEvidence& evidence, const OpeningGrid& grid, double front_m,
                  OpeningRectangle& rectangle);

}  // namespace limen
