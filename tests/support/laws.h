// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "limen/geometry/polygon.h"
#include "limen/geometry/rigid.h"

/// Laws that hold for anything: rapidcheck makes the cases up and, where one fails, looks for a smaller one.
namespace limen::testing_laws {

/// The same cases in every run; RC_PARAMS="seed=2 max_success=1000" asks for others.
inline const bool kSameCases = setenv("RC_PARAMS", "seed=1", 0) == 0;

/// A multiple of `step` from `low` to `high`.
inline double number(double low, double high, double step = 1e-3) {
  const auto steps = static_cast<int>(std::floor((high - low) / step));
  return low + step * *rc::gen::inRange(0, steps + 1);
}

inline Vector3d vector(double bound) {
  return {number(-bound, bound), number(-bound, bound), number(-bound, bound)};
}

/// Any rotation, and a shift of up to `shift_m` along each axis.
inline Rigid3 motion(double shift_m = 100.0) {
  Rigid3 b_from_a;
  const double turn = number(0.0, std::numbers::pi);
  const double about = number(0.0, 2.0 * std::numbers::pi);
  const double height = number(-1.0, 1.0);
  const double side = std::sqrt(std::max(0.0, 1.0 - height * height));
  const Vector3d axis(side * std::cos(about), side * std::sin(about), height);
  b_from_a.rotation = rotation_exp(turn * axis.normalized());
  b_from_a.translation = vector(shift_m);
  return b_from_a;
}

/// A ring without crossings about a place near 0, 0: seen from there its corners follow one another, so that
/// triangles, convex rings and stars come up. Counter-clockwise, 3 to 12 corners.
inline Ring ring() {
  const Vector2d middle(number(-2.0, 2.0), number(-2.0, 2.0));
  const int corners = *rc::gen::inRange(3, 13);
  Ring ring;
  for (int k = 0; k < corners; ++k) {
    const double angle = 2.0 * std::numbers::pi * (k + number(0.0, 0.9)) / corners;
    ring.push_back(middle + number(0.3, 3.0) * Vector2d(std::cos(angle), std::sin(angle)));
  }
  return ring;
}

/// Some polygons, which may overlap; some with a hole.
inline std::vector<Polygon> polygons() {
  std::vector<Polygon> made;
  for (int k = *rc::gen::inRange(1, 4); k > 0; --k) {
    Polygon polygon{ring(), {}};
    if (*rc::gen::inRange(0, 2) == 1) {
      Vector2d middle = Vector2d::Zero();
      for (const Vector2d& p : polygon.outer) middle += p / static_cast<double>(polygon.outer.size());
      Ring hole;
      for (const Vector2d& p : polygon.outer) hole.insert(hole.begin(), middle + 0.2 * (p - middle));
      polygon.holes.push_back(hole);
    }
    made.push_back(polygon);
  }
  return made;
}

}  // namespace limen::testing_laws
