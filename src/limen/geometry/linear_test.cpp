// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/geometry/linear.h"

#include <cmath>

#include "support/laws.h"

namespace limen {
namespace {

using namespace testing_laws;

Matrix6d any_matrix(double bound) {
  Matrix6d matrix;
  for (Eigen::Index i = 0; i < 36; ++i) matrix(i / 6, i % 6) = number(-bound, bound);
  return matrix;
}

RC_GTEST_PROP(LinearLaws, ASpectrumPutsTheMatrixTogether, ()) {
  const Matrix6d root = any_matrix(2.0);
  const Matrix6d symmetric = root + root.transpose();
  const Spectrum6 spectrum = spectrum_of(symmetric);
  const Matrix6d again = spectrum.vectors * spectrum.values.asDiagonal() * spectrum.vectors.transpose();
  RC_ASSERT((again - symmetric).norm() < 1e-13 * (1.0 + symmetric.norm()));
  RC_ASSERT((spectrum.vectors.transpose() * spectrum.vectors - Matrix6d::Identity()).norm() < 1e-13);
  for (Eigen::Index k = 1; k < 6; ++k) RC_ASSERT(spectrum.values[k - 1] <= spectrum.values[k]);
}

RC_GTEST_PROP(LinearLaws, WhatIsSolvedSolves, ()) {
  const Matrix6d root = any_matrix(2.0);
  const Matrix6d symmetric = root * root.transpose() + 1e-3 * Matrix6d::Identity();
  const Vector6d right = any_matrix(5.0).col(0);
  const Vector6d x = solve_symmetric(symmetric, right);
  RC_ASSERT((symmetric * x - right).norm() < 1e-13 * (1.0 + symmetric.norm() * x.norm()));
  const Matrix6d inverse = inverse_of(symmetric);
  RC_ASSERT((inverse * symmetric - Matrix6d::Identity()).norm() <
            1e-13 * (1.0 + symmetric.norm() * inverse.norm()));
}

TEST(Linear, UnitsApartByNineOrdersOfMagnitudeAreNoMatter) {
  Vector6d scale;
  scale << 1e-5, 1e4, 1.0, 1e-3, 1e2, 1e-1;
  Matrix6d matrix = scale * scale.transpose();
  matrix.diagonal() += scale.cwiseAbs2();
  const Vector6d x = Vector6d::Ones();
  EXPECT_LT((solve_symmetric(matrix, matrix * x) - x).cwiseAbs().maxCoeff(), 1e-4);
  const Matrix6d unit = inverse_of(matrix) * matrix;
  EXPECT_LT((scale.asDiagonal() * unit * scale.cwiseInverse().asDiagonal() - Matrix6d::Identity()).norm(),
            1e-9);
}

TEST(Linear, WhatNothingHoldsStaysWhereItIs) {
  Matrix6d held = Matrix6d::Zero();
  held.topLeftCorner<3, 3>() = 4.0 * Matrix3d::Identity();
  const Vector6d x = solve_symmetric(held, Vector6d::Constant(2.0));
  EXPECT_EQ(x.head<3>(), Vector3d::Constant(0.5));
  EXPECT_EQ(x.tail<3>(), Vector3d::Zero());
}

TEST(Linear, AllSizesAreSolvedAlike) {
  const Matrix3d small = (Matrix3d() << 4, 1, 0, 1, 3, -1, 0, -1, 5).finished();
  const Vector3d right(1, -2, 3);
  const Vector3d x = solve_symmetric(small, right);
  EXPECT_LT((small * x - right).norm(), 1e-14);
  EXPECT_EQ(solve_symmetric(Eigen::MatrixXd(small), Eigen::VectorXd(right)), Eigen::VectorXd(x));
  Matrix4d larger = Matrix4d::Identity();
  larger.topLeftCorner<3, 3>() = small;
  EXPECT_EQ(solve_symmetric(larger, Eigen::Vector4d(1, -2, 3, 7)), Eigen::Vector4d(x.x(), x.y(), x.z(), 7));
  EXPECT_LT((inverse_of(larger) * larger - Matrix4d::Identity()).norm(), 1e-14);
}

RC_GTEST_PROP(LinearLaws, ADeterminantIsTheProductOfTheSpectrum, ()) {
  const Matrix6d any = any_matrix(3.0);
  const Matrix6d definite = any * any.transpose() + 0.1 * Matrix6d::Identity();
  const double sum = spectrum_of(definite).values.array().log().sum();
  RC_ASSERT(std::abs(log_determinant_of(definite) - sum) < 1e-6);
}

TEST(Linear, TheDeterminantOfASingularMatrixHasALogarithmToo) {
  EXPECT_TRUE(std::isfinite(log_determinant_of(Matrix6d::Zero())));
  Matrix6d flat = Matrix6d::Identity();
  flat(5, 5) = 0.0;
  EXPECT_LT(log_determinant_of(flat), -600.0);
}

TEST(Linear, ASkewMatrixIsACrossProduct) {
  const Vector3d a(1.0, -2.0, 0.5);
  const Vector3d b(0.3, 4.0, -1.0);
  EXPECT_EQ(skew(a) * b, a.cross(b));
}

}  // namespace
}  // namespace limen
