// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/extract/segments/segments.h"

namespace limen {

/// When two edges are one.
struct MergeOptions {
  double beside_m = 0.015;     ///< a border this near to a crease is the crease
  double same_m = 0.012;       ///< edges of one kind this near to one another are one
  double max_angle_deg = 4.0;  ///< between two edges that are one
  double join_gap_m = 0.15;    ///< pieces of one line are joined across gaps up to this
  double corner_m = 0.08;      ///< an end this near to a corner with another edge is drawn up to it
  double min_length_m = 0.2;   ///< shorter rests are dropped
};

/// Every edge once: what better known edges cover is cut off (creases before borders, then by length), pieces
/// of one line become one, ends that nearly meet in a corner do so. Longest first.
std::vector<DetectedEdge> merged_edges(std::vector<DetectedEdge> edges, const MergeOptions& options);

}  // namespace limen
