// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "limen/geometry/polygon.h"

namespace limen {

/// Corners of a triangle, counter-clockwise.
using Triangle2 = std::array<Vector2d, 3>;

/// Cuts a polygon with holes into triangles that have its own corners only and cover it exactly once.
/// Rings may run either way, repeat corners, touch themselves and one another, but not cross; collinear
/// corners and spikes are passed over. A polygon without area gives no triangle. Ear clipping, holes joined
/// by bridges: O(n^2), for the hundreds of corners that a face of a building has.
std::vector<Triangle2> triangulate(const Polygon& polygon);

}  // namespace limen
