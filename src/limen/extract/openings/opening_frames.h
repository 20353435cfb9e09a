// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "limen/extract/openings/opening_rectangles.h"
#include "limen/extract/openings/opening_separator.h"

namespace limen {

/// A rectangle of a wall and what is seen of the frame in it.
struct FramedRectangle {
  OpeningRectangle rectangle;
  std::optional<double> front_m;            ///< as front_depth() says
  std::array<SideSeparator, 2> inner = {};  ///< of the frame's right and left bar, towards the pane; outwards
};

/// Where the upright bars of a frame end towards the pane.
std::array<SideSeparator, 2> frame_edges(const Scan& scan, const WallEvidence& evidence,
                                         const OpeningGrid& grid, const OpeningRectangle& rectangle,
                                         double front_m);

/// Frames of a wall that lie equally deep are often equally wide. Where the windows say so, each upright side
/// is placed again by its frame's inner edge and the width that the other windows tell.
void share_frame_widths(std::vector<FramedRectangle>& windows);

}  // namespace limen
