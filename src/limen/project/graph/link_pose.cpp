// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/link_pose.h"

#include <cmath>

#include "limen/geometry/linear.h"

namespace limen {

LinkPose reversed(const LinkPose& pose) {
  const Rigid3 back = inverse(pose.target_from_source);
  LinkPose other = pose;
  other.target_from_source = back;
  other.centre = back * pose.centre;
  other.covariance = moved_covariance(pose, back, other.centre);
  return other;
}

Matrix6d moved_covariance(const LinkPose& pose, const Rigid3& b_from_target, const Vector3d& at) {
  // A motion (w, v about c) is (R w, R v + R w x (at - c')) about `at`, c' = the centre in b.
  Matrix6d jacobian = Matrix6d::Zero();
  jacobian.topLeftCorner<3, 3>() = b_from_target.rotation;
  jacobian.bottomRightCorner<3, 3>() = b_from_target.rotation;
  jacobian.bottomLeftCorner<3, 3>() = -skew(at - b_from_target * pose.centre) * b_from_target.rotation;
  return jacobian * pose.covariance * jacobian.transpose();
}

Vector6d misfit(const LinkPose& measured, const Rigid3& predicted) {
  const Vector3d in_source = inverse(measured.target_from_source) * measured.centre;
  Vector6d e;
  e.head<3>() = rotation_log(predicted.rotation * measured.target_from_source.rotation.transpose());
  e.tail<3>() = predicted * in_source - measured.centre;
  return e;
}

bool is_one_place(const Vector6d& misfit) {
  return misfit.head<3>().norm() <= kOtherPlaceRad && misfit.tail<3>().norm() <= kOtherPlaceM;
}

/// By a Cholesky factor on the stack: solving a graph asks for this millions of times.
double chi_square(const Vector6d& misfit, const Matrix6d& covariance) {
  Matrix6d lower;
  Vector6d whitened;
  double squared = 0.0;
  for (Eigen::Index i = 0; i < 6; ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) {
      double left = covariance(i, j);
      for (Eigen::Index k = 0; k < j; ++k) left -= lower(i, k) * lower(j, k);
      if (i != j) {
        lower(i, j) = left / lower(j, j);
        continue;
      }
      if (!(left > 0.0)) return misfit.dot(solve_symmetric(covariance, misfit));
      lower(i, i) = std::sqrt(left);
    }
    double left = misfit[i];
    for (Eigen::Index k = 0; k < i; ++k) left -= lower(i, k) * whitened[k];
    whitened[i] = left / lower(i, i);
    squared += whitened[i] * whitened[i];
  }
  return squared;
}

}  // namespace limen
