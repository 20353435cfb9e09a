// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/extract/segments/segments_image.h"

namespace limen {

/// A stretch of an outline that is straight within what its points allow.
struct StraightRun {
  Strip line;         ///< through the outline; the filled side is inward; begin_m and end_m bound the run
  bool hole = false;  ///< of a hole of the image
};

/// The straight runs of a plane's outlines that are longer than `min_length_m`: corners after Douglas and
/// Peucker 1973, then each run grows from its longest piece on, longest first.
std::vector<StraightRun> straight_runs(const PlaneImage& image, double min_length_m);

}  // namespace limen
