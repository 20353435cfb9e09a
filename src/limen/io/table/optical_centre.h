// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/geometry/rigid.h"

namespace limen {

/// Whether a static scanner can have seen `points` from `candidate` (same frame, metres):
///  - it lies within the box round the points, grown by a tenth of its sides and half a metre;
///  - at most one point in a thousand is nearer than 0.1 m (no scanner measures there);
///  - most points are the nearest ones in their direction (a scanner does not see through walls).
bool can_be_scanner(const std::vector<Vector3d>& points, const Vector3d& candidate);

}  // namespace limen
