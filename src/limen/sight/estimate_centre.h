// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "limen/model/features.h"

namespace limen {

/// A scanner position found from the data, and how well the data bears it out.
struct EstimatedCentre {
  Vector3d centre = Vector3d::Zero();  ///< about the scan's local origin, metres
  Vector3d up = Vector3d::UnitZ();     ///< the axis the scanner turned about, sign open
  double misfit = 0.0;                 ///< median |log density - model|; below 0.08 the model holds
  double sigma_m = 0.0;                ///< one standard deviation per axis, the largest
};

/// Where a static scanner must have stood, from the density of its points on planes: a scanner of even
/// angular steps puts h / (r^3 cos e) points on a square metre of a plane at distance h, range r, elevation
/// e. Robust fit of centre and rate over fully covered tiles (`features.samples`). Empty where there are too
/// few tiles or the density does not follow the model (a joined, mobile or evenly thinned cloud). The
/// scanner's vertical axis is taken from z and from the normals of the largest planes: whichever fits best.
std::optional<EstimatedCentre> estimate_centre(const Features& features);

/// A place that somebody claims, held against the same law.
struct TestedCentre {
  double claim_misfit = 0.0;  ///< of the density where the scanner is said to have stood
  EstimatedCentre nearby;     ///< where the fit comes to rest that starts there
};

/// Whether the density has an upper bound, as that of a cloud which was thinned to a spacing has: then
/// neither the density on planes nor the spread over directions shows where the scanner was.
bool evenly_thinned(const Features& features);

/// Empty where there are too few tiles to tell.
std::optional<TestedCentre> test_centre(const Features& features, const Vector3d& claim);

}  // namespace limen
