// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limen/geometry/plane.h"
#include "limen/model/scan.h"

namespace limen {

/// A plane's points by parts that hang together: squares of `gap_m` that touch, also at a corner. Largest
/// first, each ascending.
std::vector<std::vector<std::uint32_t>> touching_parts(const Scan& scan, const PlaneFit& fit,
                                                       const std::vector<std::uint32_t>& points,
                                                       double gap_m);

}  // namespace limen
