// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/geometry/plane.h"

#include <cmath>

#include "limen/geometry/linear.h"

namespace limen {

Plane transformed(const Rigid3& b_from_a, const Plane& plane_in_a) {
  const Vector3d normal = b_from_a.rotation * plane_in_a.normal;
  return {normal, plane_in_a.offset + normal.dot(b_from_a.translation)};
}

Plane shifted(const Plane& plane, const Vector3d& shift) {
  return {plane.normal, plane.offset - plane.normal.dot(shift)};
}

PlaneFrame make_frame(const Plane& plane, const Vector3d& near) {
  PlaneFrame frame;
  frame.origin = plane.project(near);
  const Vector3d horizontal = Vector3d::UnitZ().cross(plane.normal);
  if (horizontal.norm() > 0.05) {
    frame.u = horizontal.normalized();
  } else {
    frame.u = (Vector3d::UnitX() - plane.normal.x() * plane.normal).normalized();
  }
  frame.v = plane.normal.cross(frame.u);
  return frame;
}

PlaneFit fit_plane(const PointMoments& moments) {
  PlaneFit fit;
  fit.centroid = moments.mean();
  // By iteration: the closed form loses the small eigenvalue, which is the one that matters here.
  const Spectrum3 spectrum = spectrum_of(moments.covariance());
  fit.variances = spectrum.values.cwiseMax(0.0);
  fit.plane.normal = spectrum.vectors.col(0).normalized();
  fit.plane.offset = fit.plane.normal.dot(fit.centroid);
  fit.rms_m = std::sqrt(fit.variances[0]);
  return fit;
}

}  // namespace limen
