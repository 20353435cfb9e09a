// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/deviation/deviation.h"

namespace limen {

/// The pieces into which points fall whose cubes of `cell_m` touch; those of at least `min_points`, most
/// points first. `low` and `high`: the model's extent.
std::vector<UnmodelledMatter> pieces_of(const std::vector<Vector3d>& points, double cell_m,
                                        std::size_t min_points, const Vector3d& low, const Vector3d& high);

}  // namespace limen
