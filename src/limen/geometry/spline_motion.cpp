// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/geometry/spline_motion.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace limen {

double place_among(const std::vector<double>& times_s, double time_s) {
  const auto after = std::upper_bound(times_s.begin(), times_s.end(), time_s);
  if (after == times_s.begin()) return 0.0;
  if (after == times_s.end()) return static_cast<double>(times_s.size() - 1);
  const auto before = after - 1;
  return static_cast<double>(before - times_s.begin()) + (time_s - *before) / (*after - *before);
}

std::array<SplineShare, 4> spline_shares(int knots, double place) {
  const int span = std::clamp(static_cast<int>(std::floor(place)), 0, knots - 2);
  const double t = place - span;
  const double s = 1.0 - t;
  std::array<SplineShare, 4> shares{{{span - 1, s * s * s / 6.0},
                                     {span, (3.0 * t * t * t - 6.0 * t * t + 4.0) / 6.0},
                                     {span + 1, (3.0 * s * s * s - 6.0 * s * s + 4.0) / 6.0},
                                     {span + 2, t * t * t / 6.0}}};
  // Control points beyond the ends lie in a line with the last two.
  if (shares[0].control < 0) {
    shares[1].weight += 2.0 * shares[0].weight;
    shares[2].weight -= shares[0].weight;
    shares[0] = {0, 0.0};
  }
  if (shares[3].control >= knots) {
    shares[2].weight += 2.0 * shares[3].weight;
    shares[1].weight -= shares[3].weight;
    shares[3] = {knots - 1, 0.0};
  }
  return shares;
}

std::vector<Vector6d> spline_controls(const std::vector<Vector6d>& values) {
  // c[0] = v[0], c[k-1] + 4 c[k] + c[k+1] = 6 v[k], c[n] = v[n]: eliminated from the front.
  std::vector<Vector6d> controls = values;
  const std::size_t n = values.size();
  if (n < 3) return controls;
  std::vector<double> above(n, 0.0);
  for (std::size_t k = 1; k + 1 < n; ++k) {
    const double pivot = 4.0 - above[k - 1];
    above[k] = 1.0 / pivot;
    controls[k] = (6.0 * values[k] - controls[k - 1]) / pivot;
  }
  for (std::size_t k = n - 2; k > 0; --k) controls[k] -= above[k] * controls[k + 1];
  return controls;
}

SplineMotion::SplineMotion(std::vector<double> times_s, const std::vector<Vector6d>& values,
                           const Vector3d& pivot)
    : times_s_(std::move(times_s)), controls_(spline_controls(values)), pivot_(pivot) {}

Vector6d SplineMotion::value(double time_s) const {
  Vector6d sum = Vector6d::Zero();
  for (const SplineShare& share :
       spline_shares(static_cast<int>(times_s_.size()), place_among(times_s_, time_s)))
    sum += share.weight * controls_[static_cast<std::size_t>(share.control)];
  return sum;
}

Rigid3 SplineMotion::at(double time_s) const {
  const Vector6d now = value(time_s);
  Rigid3 motion;
  motion.rotation = rotation_exp(now.head<3>());
  motion.translation = pivot_ - motion.rotation * pivot_ + now.tail<3>();
  return motion;
}

Vector3d SplineMotion::moved(const Vector3d& x, double time_s) const {
  const Vector6d now = value(time_s);
  return pivot_ + rotation_exp(now.head<3>()) * (x - pivot_) + now.tail<3>();
}

}  // namespace limen
