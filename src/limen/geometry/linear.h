// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "limen/geometry/rigid.h"

// Small dense systems, solved in one place: Eigen's decompositions cost seconds of compiling wherever they
// are used.

namespace limen {

/// Of a turn (radians) and a shift (metres).
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// Eigenvalues of a symmetric matrix, ascending, and the unit eigenvectors in the columns that belong to
/// them.
struct Spectrum3 {
  Vector3d values;
  Matrix3d vectors;
};
struct Spectrum6 {
  Vector6d values;
  Matrix6d vectors;
};
Spectrum3 spectrum_of(const Matrix3d& symmetric);
Spectrum6 spectrum_of(const Matrix6d& symmetric);

/// x of symmetric * x = right, by LDL^T: `symmetric` is positive or negative semidefinite. 0 along what it
/// leaves open.
Vector3d solve_symmetric(const Matrix3d& symmetric, const Vector3d& right);
Eigen::Vector4d solve_symmetric(const Matrix4d& symmetric, const Eigen::Vector4d& right);
Vector6d solve_symmetric(const Matrix6d& symmetric, const Vector6d& right);
Eigen::VectorXd solve_symmetric(const Eigen::MatrixXd& symmetric, const Eigen::VectorXd& right);

/// Inverse of a regular matrix.
Matrix3d inverse_of(const Matrix3d& matrix);
Matrix4d inverse_of(const Matrix4d& matrix);
Matrix6d inverse_of(const Matrix6d& matrix);
Eigen::MatrixXd inverse_of(const Eigen::MatrixXd& matrix);

/// log of the determinant of a symmetric positive definite matrix, by its blocks; finite where one is
/// singular.
double log_determinant_of(const Matrix6d& definite);

/// A matrix as left * diagonal(values) * right^T, the
/// values descending, not negative.
struct SingularValues3 {
  Matrix3d left;
  Vector3d values;
  Matrix3d right;
};
SingularValues3 singular_values_of(const Matrix3d& matrix);

/// v^: skew(v) * x = v x x.
Matrix3d skew(const Vector3d& v);

}  // namespace limen
