// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "limen/extract/targets/found_target.h"

namespace limen {

/// Points are about the scanner's centre, metres.

/// Where a sphere of the radius seems to be that has `front` on it, by the points about; with its residual.
struct SphereGuess {
  Vector3d centre = Vector3d::Zero();
  double rms_m = 0.0;
  std::size_t points = 0;
};
std::optional<SphereGuess> guess_sphere(const Vector3d& front, std::span<const Vector3d> about,
                                        double radius_m);

/// The sphere near `start`, by all points in a cone of 1.5 radii round it. Nothing where what is seen there
/// is no sphere of this radius, or too little of it: the range residuals have to be noise over the face, rays
/// pass beside it, and none through it.
std::optional<FoundTarget> fit_sphere(const Vector3d& start, std::span<const Vector3d> points,
                                      double radius_m);

}  // namespace limen
