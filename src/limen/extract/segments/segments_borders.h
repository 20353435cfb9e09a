// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
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

/// What is known at one place along a border: bins of the width at which nearly every one holds points.
struct BorderBin {
  double t = 0.0;           ///< along the line, of the outermost point
  double h = 0.0;           ///< inward, of the outermost point
  std::uint32_t point = 0;  ///< the outermost point, index into the scan
  bool found = false;       ///< false: no point near the line
  bool fits = false;        ///< the outermost point is where the line says
};

/// A line fitted to the outermost points of a plane.
struct BorderFit {
  Strip line;                    ///< the edge itself: h = 0; begin_m, end_m of the bins
  double bin_m = 0.0;            ///< width of a bin
  double shortfall_m = 0.0;      ///< by how much the outermost points fall short of the edge, on average
  double sigma_m = 0.0;          ///< one standard deviation of the edge's place across
  double angle_sigma_rad = 0.0;  ///< the same of its direction
  std::vector<BorderBin> bins;
};

/// How near a plane's points come to a line in it, on the inward side of the line.
struct Approach {
  double nearest_m = 0.0;    ///< median over the bins of the distance of the nearest point from line.low_m on
  double shortfall_m = 0.0;  ///< what this distance is on average where the surface reaches the line
  double spread_m = 0.0;     ///< between the quarters of the distances: none where rows run along the line
  double filled = 0.0;       ///< share of the bins with points
  double first_m = 0.0;      ///< along the line, of the first and the last bin with a point that near
  double last_m = 0.0;
};
/// `line.low_m`: points nearer to the line do not count.
Approach approach_of(const PlaneImage& image, const Strip& line);

/// Fits a line to the outermost points along a run and `beyond_m` further on either side.
///
/// A surface's samples end before the surface does. How far before is shown by the samples themselves: the
/// mean distance from a place within to the next sample, sum g^2 / (2 sum g) over the gaps g between samples
/// one behind the other, is the same for rows of even spacing as for samples at random. Empty: too few
/// points, or a border too ragged or bent to be a line.
/// Points marked in `ambiguous` (by their index in the scan) do not count.
std::optional<BorderFit> fit_border(const PlaneImage& image, const StraightRun& run, double beyond_m,
                                    const std::vector<char>& ambiguous);

}  // namespace limen
