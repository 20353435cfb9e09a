// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "limen/geometry/polygon.h"

namespace limen {

/// How one outline of an opening has to move to lie on another of the same wall (2022, section 5: flexible
/// outlines).
struct OutlineFit {
  Vector2d shift_m = Vector2d::Zero();  ///< of the first
  Vector2d sigma_m = Vector2d::Ones();  ///< one standard deviation of it
  double growth_m = 0.0;  ///< by which the second is wider all round: an opening splays through its wall
  double rms_m = 0.0;     ///< of what is left between the two, root mean square: large for another shape
};

/// Least squares over the points of the first outline against the nearest places of the second: a crown and
/// its shoulders hold the shift both ways, where a rectangle would only have its highest point. None where an
/// outline has fewer than three points. Rings counter-clockwise, plane coordinates, metres. `growth_sigma_m`:
/// how much the two may differ in width, each way, > 0.
std::optional<OutlineFit> fit_outlines(const Ring& first, const Ring& second, double growth_sigma_m);

}  // namespace limen
