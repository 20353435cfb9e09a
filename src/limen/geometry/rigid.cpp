// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/geometry/rigid.h"

#include <cmath>

#include "limen/base/error.h"
#include "limen/geometry/linear.h"

namespace limen {

Rigid3 operator*(const Rigid3& c_from_b, const Rigid3& b_from_a) {
  return {c_from_b.rotation * b_from_a.rotation,
          c_from_b.rotation * b_from_a.translation + c_from_b.translation};
}

Rigid3 inverse(const Rigid3& b_from_a) {
  const Matrix3d transposed = b_from_a.rotation.transpose();
  return {transposed, -(transposed * b_from_a.translation)};
}

Matrix4d to_matrix(const Rigid3& b_from_a) {
  Matrix4d matrix = Matrix4d::Identity();
  matrix.topLeftCorner<3, 3>() = b_from_a.rotation;
  matrix.topRightCorner<3, 1>() = b_from_a.translation;
  return matrix;
}

Rigid3 from_matrix(const Matrix4d& matrix, double tolerance) {
  const Matrix3d block = matrix.topLeftCorner<3, 3>();
  const bool finite = matrix.allFinite();
  const Eigen::RowVector4d last(0, 0, 0, 1);
  const bool rigid = finite &&
                     (block * block.transpose() - Matrix3d::Identity()).cwiseAbs().maxCoeff() <= tolerance &&
                     block.determinant() > 0 && (matrix.row(3) - last).cwiseAbs().maxCoeff() <= tolerance;
  if (!rigid) {
    throw Error(
        "the 4 x 4 matrix is not a rigid motion (scale, shear, mirror or a last row other than 0 0 0 1)", "",
        "give a rotation and a translation");
  }
  return {nearest_rotation(block), matrix.topRightCorner<3, 1>()};
}

Matrix3d nearest_rotation(const Matrix3d& matrix) {
  // What is off by rounding alone needs one step of Newton and Schulz, which squares how far it is off.
  constexpr double kNear = 1e-8;
  const Matrix3d off = matrix.transpose() * matrix - Matrix3d::Identity();
  if (off.cwiseAbs().maxCoeff() < kNear && matrix.determinant() > 0)
    return matrix * (Matrix3d::Identity() - 0.5 * off);
  const SingularValues3 svd = singular_values_of(matrix);
  const Vector3d signs(1, 1, (svd.left * svd.right.transpose()).determinant() < 0 ? -1 : 1);
  return svd.left * signs.asDiagonal() * svd.right.transpose();
}

Matrix3d rotation_exp(const Vector3d& rotation_vector) {
  const double angle = rotation_vector.norm();
  if (angle < 1e-300) return Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, rotation_vector / angle).toRotationMatrix();
}

Vector3d rotation_log(const Matrix3d& rotation) {
  Eigen::Quaterniond q(rotation);
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  const double sine = q.vec().norm();
  if (sine < 1e-300) return Vector3d::Zero();
  return q.vec() / sine * (2.0 * std::atan2(sine, q.w()));
}

double rotation_angle(const Matrix3d& rotation) {
  return rotation_log(rotation).norm();
}

Rigid3 to_local(const Rigid3& target_from_source, const Vector3d& source_origin,
                const Vector3d& target_origin) {
  return {target_from_source.rotation,
          target_from_source.rotation * source_origin + target_from_source.translation - target_origin};
}

Rigid3 to_world(const Rigid3& local_target_from_source, const Vector3d& source_origin,
                const Vector3d& target_origin) {
  return {local_target_from_source.rotation, local_target_from_source.translation + target_origin -
                                                 local_target_from_source.rotation * source_origin};
}

}  // namespace limen
