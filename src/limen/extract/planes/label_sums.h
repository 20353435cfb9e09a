// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limen/extract/cells/morton_order.h"
#include "limen/geometry/plane.h"

namespace limen {

/// Moments of each plane's points about the curve's anchor; `labels[k]` is the plane of the k-th point along
/// the curve, or -1. The same for any number of threads.
std::vector<PointMoments> label_sums(const MortonOrder& order, const std::vector<std::int32_t>& labels,
                                     std::size_t planes);

}  // namespace limen
