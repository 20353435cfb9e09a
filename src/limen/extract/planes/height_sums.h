// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace limen {

/// Sums of heights h over places (u, v) of a plane.
struct HeightSums {
  double n = 0.0;
  double u = 0.0;
  double v = 0.0;
  double h = 0.0;
  double uu = 0.0;
  double uv = 0.0;
  double vv = 0.0;
  double uh = 0.0;
  double vh = 0.0;
  double hh = 0.0;

  void add(double pu, double pv, double ph) {
    n += 1.0;
    u += pu;
    v += pv;
    h += ph;
    uu += pu * pu;
    uv += pu * pv;
    vv += pv * pv;
    uh += pu * ph;
    vh += pv * ph;
    hh += ph * ph;
  }
  void add(const HeightSums& o) {
    n += o.n;
    u += o.u;
    v += o.v;
    h += o.h;
    uu += o.uu;
    uv += o.uv;
    vv += o.vv;
    uh += o.uh;
    vh += o.vh;
    hh += o.hh;
  }
  /// Squares about the plane that explains them best, its slopes held by `ridge` (noise over slope, squared).
  [[nodiscard]] double squares(double ridge) const {
    const double m = 1.0 / n;
    const double cuu = uu - u * u * m + ridge;
    const double cuv = uv - u * v * m;
    const double cvv = vv - v * v * m + ridge;
    const double cuh = uh - u * h * m;
    const double cvh = vh - v * h * m;
    const double det = cuu * cvv - cuv * cuv;
    return hh - h * h * m - (cvv * cuh * cuh - 2.0 * cuv * cuh * cvh + cuu * cvh * cvh) / det;
  }
};

}  // namespace limen
