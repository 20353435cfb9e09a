// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace limen {

using Eigen::Matrix3d;
using Eigen::Matrix4d;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// A rigid motion x_in_b = rotation * x_in_a + translation; variables are named `b_from_a`.
/// `rotation` is orthonormal with determinant +1; `translation` in metres.
struct Rigid3 {
  Matrix3d rotation = Matrix3d::Identity();
  Vector3d translation = Vector3d::Zero();
};

inline Vector3d operator*(const Rigid3& b_from_a, const Vector3d& x_in_a) {
  return b_from_a.rotation * x_in_a + b_from_a.translation;
}

/// c_from_a = c_from_b * b_from_a.
Rigid3 operator*(const Rigid3& c_from_b, const Rigid3& b_from_a);
Rigid3 inverse(const Rigid3& b_from_a);

/// The 4 x 4 homogeneous matrix, last row 0 0 0 1.
Matrix4d to_matrix(const Rigid3& b_from_a);
/// Throws Error where `matrix` is not rigid within `tolerance` (scale, shear, mirror, last row, NaN).
Rigid3 from_matrix(const Matrix4d& matrix, double tolerance = 1e-6);

/// The closest rotation to a matrix (singular value decomposition, determinant +1).
Matrix3d nearest_rotation(const Matrix3d& matrix);
/// Rotation about the unit axis of `rotation_vector` by its length in radians.
Matrix3d rotation_exp(const Vector3d& rotation_vector);
/// The rotation vector, radians, length in [0, pi].
Vector3d rotation_log(const Matrix3d& rotation);
/// Angle of a rotation in [0, pi], radians; exact near 0 and near pi.
double rotation_angle(const Matrix3d& rotation);

/// The same motion between frames shifted to local origins: x = origin + x_local on either side.
/// No digits are lost: the large numbers meet only in one subtraction.
Rigid3 to_local(const Rigid3& target_from_source, const Vector3d& source_origin,
                const Vector3d& target_origin);
Rigid3 to_world(const Rigid3& local_target_from_source, const Vector3d& source_origin,
                const Vector3d& target_origin);

}  // namespace limen
