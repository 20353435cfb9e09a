// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/extract/surface/surface_details.h"
#include "limen/geometry/rigid.h"

namespace limen {

/// A straight flight of stairs, seen from above or from below: steps of one run and rise. It is the
/// building's, and is over the same place on every storey, exactly as designed.
struct Flight {
  Vector3d foot = Vector3d::Zero();  ///< middle of the lowest riser that was seen; upright frame
  Vector2d up = Vector2d::UnitX();   ///< unit vector, level: where it leads up
  double slope = 0.0;                ///< rise over run
  double length_m = 0.0;             ///< level, to the highest riser that was seen

  /// Whether `x` is of the flight: steps, strings, railings, those not seen as well.
  [[nodiscard]] bool contains(const Vector3d& x) const;
};

/// Flights of at least three risers among the flat pieces of a scan; upright frame, normals to the scanner.
std::vector<Flight> find_flights(const std::vector<SurfaceDetail>& details);

}  // namespace limen
