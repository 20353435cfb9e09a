// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "limen/extract/segments.h"
#include "limen/extract/segments_image.h"

namespace limen {

/// The pieces of the lines in which planes meet, where both have points next to the line and one of them ends
/// there. `images[k]` belongs to Features::planes[k].
std::vector<DetectedEdge> find_creases(const Features& features,
                                       const std::vector<std::unique_ptr<PlaneImage>>& images,
                                       const SegmentOptions& options);

}  // namespace limen
