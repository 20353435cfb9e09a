// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "limen/geometry/linear.h"
#include "limen/geometry/rigid.h"

namespace limen {

/// The place of a time among ascending times: k + share where it lies between time k and k + 1; the ends
/// for what lies outside. At least two times.
double place_among(const std::vector<double>& times_s, double time_s);

/// A share of one control point.
struct SplineShare {
  int control = 0;
  double weight = 0.0;
};

/// The value of a natural uniform cubic B-spline at `place` (0 .. knots - 1) as shares of its control points,
/// as many as it has knots. Beyond the ends the control points go on in a line, so that the second derivative
/// vanishes there. What is not needed has weight 0.
std::array<SplineShare, 4> spline_shares(int knots, double place);

/// The control points of the natural cubic spline through `values`, one for each knot.
std::vector<Vector6d> spline_controls(const std::vector<Vector6d>& values);

/// A small motion that changes with time: x becomes pivot + exp(turn) (x - pivot) + shift. (turn, shift) is
/// the natural cubic spline through the values at the knots over the number of the knot, and that goes evenly
/// with time from knot to knot. Before the first knot and after the last it stays.
class SplineMotion {
 public:
  /// Times in seconds, ascending, two or more; of each the turn (radians) and shift (metres).
  SplineMotion(std::vector<double> times_s, const std::vector<Vector6d>& values, const Vector3d& pivot);

  [[nodiscard]] Vector6d value(double time_s) const;
  [[nodiscard]] Rigid3 at(double time_s) const;
  [[nodiscard]] Vector3d moved(const Vector3d& x, double time_s) const;

 private:
  std::vector<double> times_s_;
  std::vector<Vector6d> controls_;
  Vector3d pivot_;
};

}  // namespace limen
