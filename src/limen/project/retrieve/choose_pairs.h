// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "limen/project/store/scan_digest.h"

namespace limen {

/// Partners of each scan, the most promising first; ties by number.
std::vector<std::vector<std::size_t>> ranked_partners(const std::vector<ScanDigest>& digests);

using PairList = std::vector<std::pair<std::size_t, std::size_t>>;

/// The pairs (higher, lower number) that have a scan among the first `partners` of the other, sorted.
PairList best_pairs(const std::vector<std::vector<std::size_t>>& ranked, std::size_t partners);

}  // namespace limen
