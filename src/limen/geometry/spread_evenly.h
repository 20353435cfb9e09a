// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "limen/geometry/rigid.h"

namespace limen {

/// Indices, ascending, of at most `most` points spread evenly over the surface they show: one for each cube
/// of a grid as coarse as it has to be.
std::vector<std::uint32_t> spread_evenly(const std::vector<Vector3d>& points, std::size_t most);

}  // namespace limen
