// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limen/geometry/rigid.h"

namespace limen {

/// Neither infinite nor so large that squares of it mean nothing.
bool usable(const Vector2d& p);

/// Indices, ascending, of the points that are enough for the alpha shape with alpha_m = 4 * cell_m.
///
/// Of each square cell near a gap that could hold an empty disc (a block of 3 x 3 empty cells) the extreme
/// points in eight directions stay, so that an outline moves by less than half a cell; elsewhere one point
/// for each block of 3 x 3 cells, near its middle. No point is further than 2.9 cells from one that stays.
std::vector<std::uint32_t> thinned(const std::vector<Vector2d>& points, double cell_m);

}  // namespace limen
