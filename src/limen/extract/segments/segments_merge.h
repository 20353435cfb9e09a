// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/extract/segments/segments.h"

namespace limen {

/// Every edge once: what better known edges cover is cut off (creases before borders, then by length), pieces
/// of one line become one across gaps up to `join_gap_m`, ends that nearly meet in a corner do so. Rests
/// shorter than `min_length_m` are dropped. Longest first.
std::vector<DetectedEdge> merged_edges(std::vector<DetectedEdge> edges, double join_gap_m,
                                       double min_length_m);

}  // namespace limen
