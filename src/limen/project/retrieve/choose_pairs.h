// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "limen/project/store/scan_digest.h"

namespace limen {

/// How much two scans may have in common, from their planes alone: m^2 of planes of one direction that one
/// shift brings together, for the best of the four turns about the vertical that bring the main directions of
/// their walls together; the shifts along the two directions and the vertical are sought one by one, by
/// votes. A plane counts for no more than 5 m^2.
double common_surface(const ScanDigest& a, const ScanDigest& b);

/// Partners of each scan, the most promising first; ties by number.
std::vector<std::vector<std::size_t>> ranked_partners(const std::vector<ScanDigest>& digests);

using PairList = std::vector<std::pair<std::size_t, std::size_t>>;

/// The pairs (higher, lower number) that have a scan among the first `partners` of the other, sorted.
PairList best_pairs(const std::vector<std::vector<std::size_t>>& ranked, std::size_t partners);

}  // namespace limen
