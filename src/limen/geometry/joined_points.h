// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/base/disjoint_sets.h"
#include "limen/geometry/rigid.h"

namespace limen {

/// Sets of points that are connected: points nearer to one another than `nearer_m` (more than 0) are of one.
DisjointSets joined_points(const std::vector<Vector3d>& points, double nearer_m);

}  // namespace limen
