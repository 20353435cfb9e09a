// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "limen/geometry/rigid.h"

namespace limen {

/// The plane {x : normal . x = offset}; `normal` is a unit vector, `offset` in metres.
struct Plane {
  Vector3d normal = Vector3d::UnitZ();
  double offset = 0.0;

  [[nodiscard]] double signed_distance(const Vector3d& x) const { return normal.dot(x) - offset; }
  [[nodiscard]] Vector3d project(const Vector3d& x) const { return x - signed_distance(x) * normal; }
  [[nodiscard]] Plane flipped() const { return {-normal, -offset}; }
};

/// The plane seen in another frame.
Plane transformed(const Rigid3& b_from_a, const Plane& plane_in_a);
/// The same plane about another origin: x_new = x - shift.
Plane shifted(const Plane& plane, const Vector3d& shift);

/// A right-handed frame (u, v, normal) on a plane with an origin in it: 2-D coordinates of the plane in
/// metres.
struct PlaneFrame {
  Vector3d origin = Vector3d::Zero();
  Vector3d u = Vector3d::UnitX();
  Vector3d v = Vector3d::UnitY();

  [[nodiscard]] Vector2d to_plane(const Vector3d& x) const { return {u.dot(x - origin), v.dot(x - origin)}; }
  [[nodiscard]] Vector3d to_space(const Vector2d& p) const { return origin + p.x() * u + p.y() * v; }
};

/// A frame whose u is horizontal and v points up where the plane is not itself horizontal (then u is the x
/// axis). `near` is projected into the plane to become the origin.
PlaneFrame make_frame(const Plane& plane, const Vector3d& near);

/// Sums of points from which a least-squares plane follows; adding two sums is exact up to rounding.
/// Points are given about a nearby `anchor` chosen by the caller, so that no digits are lost.
struct PointMoments {
  double count = 0.0;
  Vector3d sum = Vector3d::Zero();
  Matrix3d outer = Matrix3d::Zero();

  void add(const Vector3d& x) {
    count += 1.0;
    sum += x;
    outer += x * x.transpose();
  }
  PointMoments& operator+=(const PointMoments& other) {
    count += other.count;
    sum += other.sum;
    outer += other.outer;
    return *this;
  }
  [[nodiscard]] Vector3d mean() const { return sum / count; }
  /// Covariance (divided by count).
  [[nodiscard]] Matrix3d covariance() const { return outer / count - mean() * mean().transpose(); }
};

/// A least-squares plane with what is known of its fit.
struct PlaneFit {
  Plane plane;
  Vector3d centroid = Vector3d::Zero();
  Vector3d variances = Vector3d::Zero();  ///< eigenvalues of the covariance, ascending, m^2: thickness first
  double rms_m = 0.0;                     ///< root mean square distance of the points to the plane
};

/// Total least squares plane of >= 3 points; the normal's sign is arbitrary.
PlaneFit fit_plane(const PointMoments& moments);

}  // namespace limen
