// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "limen/extract/segments/segments.h"
#include "limen/extract/segments/segments_image.h"

namespace limen {

struct Creases {
  std::vector<DetectedEdge> edges;
  /// Of each point of the scan: it also lies on another plane than its own, which its own does not reach: it
  /// does not tell where its own ends.
  std::vector<char> ambiguous;
};

/// The pieces of the lines in which planes meet, where both have points next to the line and one of them ends
/// there. `images[k]` belongs to Features::planes[k]; `points`: of the
/// scan.
Creases find_creases(const Features& features, const std::vector<std::unique_ptr<PlaneImage>>& images,
                     const SegmentOptions& options, std::size_t points);

}  // namespace limen
