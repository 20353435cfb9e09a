// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/match/openings/outline_fit.h"

#include <algorithm>
#include <cmath>

#include "limen/geometry/linear.h"

namespace limen {
namespace {

constexpr int kRounds = 6;
constexpr double kPointSigmaM = 0.02;  // of a point of an outline
constexpr double kStepM = 0.06;        // between the points that are compared
// Neighbouring points of an outline come from the same samples: that many say about what one says.
constexpr double kAlike = 6.0;

/// The nearest place of an outline, and which way is out of it there.
struct Nearest {
  Vector2d at = Vector2d::Zero();
  Vector2d outward = Vector2d::UnitX();
};

Nearest nearest(const Ring& ring, const Vector2d& p) {
  Nearest best;
  double least = 1e300;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const Vector2d& a = ring[k];
    const Vector2d side = ring[(k + 1) % ring.size()] - a;
    const double length = side.norm();
    if (length < 1e-6) continue;
    const double t = std::clamp((p - a).dot(side) / (length * length), 0.0, 1.0);
    const Vector2d at = a + t * side;
    const double squared = (p - at).squaredNorm();
    if (squared >= least) continue;
    least = squared;
    best = {at, Vector2d(side.y(), -side.x()) / length};
  }
  return best;
}

Ring points_along(const Ring& ring) {
  Ring points;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const Vector2d& a = ring[k];
    const Vector2d side = ring[(k + 1) % ring.size()] - a;
    const int count = std::max(1, static_cast<int>(std::lround(side.norm() / kStepM)));
    for (int i = 0; i < count; ++i) points.push_back(a + (i + 0.5) / count * side);
  }
  return points;
}

/// Root mean square distance of points to a ring that is `growth_m` narrower all round than theirs.
double left_over(const Ring& points, const Ring& ring, double growth_m) {
  double squares = 0.0;
  for (const Vector2d& p : points) {
    const Nearest on = nearest(ring, p);
    const double apart = (p - on.at).norm();
    squares += std::pow((on.outward.dot(p - on.at) < 0.0 ? -apart : apart) - growth_m, 2);
  }
  return std::sqrt(squares / static_cast<double>(points.size()));
}

}  // namespace

std::optional<OutlineFit> fit_outlines(const Ring& first, const Ring& second, double growth_sigma_m) {
  if (first.size() < 3 || second.size() < 3) return std::nullopt;
  const Ring points = points_along(first);
  OutlineFit fit;
  Matrix3d information = Matrix3d::Zero();
  for (int round = 0; round < kRounds; ++round) {
    information = Matrix3d::Zero();
    Vector3d right = Vector3d::Zero();
    double squares = 0.0;
    for (const Vector2d& p : points) {
      const Vector2d moved = p + fit.shift_m;
      const Nearest on = nearest(second, moved);
      const double gap = on.outward.dot(on.at - moved);  // to go outwards, less what the growth explains
      const Vector3d row(on.outward.x(), on.outward.y(), 1.0);
      information += row * row.transpose();
      right += row * gap;
      squares += std::pow(gap - fit.growth_m, 2);
    }
    fit.rms_m = std::sqrt(squares / static_cast<double>(points.size()));
    const double point = kAlike * std::pow(std::max(kPointSigmaM, fit.rms_m), 2);
    information /= point;
    right /= point;
    // The growth starts anew each round, near zero a priori; the shift is what is still to go.
    information(2, 2) += 1.0 / (growth_sigma_m * growth_sigma_m);
    const Vector3d step = solve_symmetric(information, right);
    fit.shift_m += step.head<2>();
    fit.growth_m = step.z();
  }
  Ring moved = first;
  for (Vector2d& p : moved) p += fit.shift_m;
  // Both ways: the corners of a rectangle are far from an arch, but no place of the arch is from it.
  fit.rms_m = std::max(left_over(points_along(moved), second, -fit.growth_m),
                       left_over(points_along(second), moved, fit.growth_m));
  const Matrix3d covariance = inverse_of(information);
  fit.sigma_m = covariance.diagonal().head<2>().cwiseMax(0.0).cwiseSqrt();
  return fit;
}

}  // namespace limen
