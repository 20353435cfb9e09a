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

/// A point with the light it sends back, in the scan's unit.
struct LitPoint {
  Vector3d x = Vector3d::Zero();  ///< about the scanner's centre, metres
  double light = 0.0;
};

/// How much the points within a board's circle about `middle` look like four quadrants: their number times
/// up to 2 / pi, at a board's centre. 0 where they are not of two kinds, lie in no plane, or are no board's.
double board_likeness(const Vector3d& middle, std::span<const LitPoint> about, double side_m);

/// The board whose centre is near `start`, by all points in a cone of 1.5 sides round it. Nothing where what
/// is seen there is no board of this size, or too little of it: each quadrant has to be in sight and of one
/// light, nothing is seen through it, and the pattern ends at its border.
std::optional<FoundTarget> fit_board(const Vector3d& start, std::span<const LitPoint> points, double side_m);

}  // namespace limen
