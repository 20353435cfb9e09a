// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "limen/model/scan.h"

namespace limen {

/// Indices of about `most` points of `scan` (all, where there are no more), chosen and ordered by how far
/// they lie from the middle of all: a scan that is moved, turned or whose points come in another order gives
/// the same points in the same order. Dense and sparse parts keep their proportion.
std::vector<std::uint32_t> steady_sample(const Scan& scan, std::size_t most);

}  // namespace limen
