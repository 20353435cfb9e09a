// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "limen/extract/openings/opening_rectangles.h"

namespace limen {

/// The side surface of an opening (reveal, lintel, sill) as far as its points tell.
struct Reveal {
  bool found = false;
  double place = 0.0;          ///< of the side at the wall's face, in the wall's frame
  double sigma_m = 1.0;        ///< one standard deviation of it
  double depth_m = 0.0;        ///< how far behind the wall's face it was seen
  double depth_sigma_m = 0.0;  ///< one standard deviation of its end, where complete
  bool complete = false;       ///< rays passed just beyond the end: it ends there
};

/// The reveals of a rectangle in the order of `kSides`, from the points whose rays crossed the wall in it.
/// `noise_m`: one standard deviation of the points; `front_m`: as front_depth() says.
std::array<Reveal, 4> find_reveals(const Scan& scan, const WallEvidence& evidence, const OpeningGrid& grid,
                                   const OpeningRectangle& rectangle, double noise_m,
                                   std::optional<double> front_m);

}  // namespace limen
