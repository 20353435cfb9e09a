// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/geometry/linear.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/SVD>

namespace limen {
namespace {

/// A square matrix of any size, row by row: one piece of code for all sizes.
class Square {
 public:
  explicit Square(std::size_t size) : size_(size), values_(size * size, 0.0) {}
  template <typename Matrix>
  explicit Square(const Matrix& matrix) : Square(static_cast<std::size_t>(matrix.rows())) {
    for (std::size_t i = 0; i < size_; ++i) {
      for (std::size_t j = 0; j < size_; ++j)
        (*this)(i, j) = matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
    }
  }

  static Square identity(std::size_t size) {
    Square square(size);
    for (std::size_t i = 0; i < size; ++i) square(i, i) = 1.0;
    return square;
  }

  [[nodiscard]] std::size_t size() const { return size_; }
  double& operator()(std::size_t i, std::size_t j) { return values_[i * size_ + j]; }
  double operator()(std::size_t i, std::size_t j) const { return values_[i * size_ + j]; }

  void swap_rows(std::size_t a, std::size_t b) {
    for (std::size_t j = 0; j < size_ && a != b; ++j) std::swap((*this)(a, j), (*this)(b, j));
  }
  void swap_columns(std::size_t a, std::size_t b) {
    for (std::size_t i = 0; i < size_ && a != b; ++i) std::swap((*this)(i, a), (*this)(i, b));
  }
  /// Adds `factor` times row `from` to row `to`, from column `first` on.
  void add_row(std::size_t to, double factor, std::size_t from, std::size_t first) {
    for (std::size_t j = first; j < size_; ++j) (*this)(to, j) += factor * (*this)(from, j);
  }

  template <typename Matrix>
  [[nodiscard]] Matrix as() const {
    Matrix matrix(size_, size_);
    for (std::size_t i = 0; i < size_; ++i) {
      for (std::size_t j = 0; j < size_; ++j)
        matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = (*this)(i, j);
    }
    return matrix;
  }

 private:
  std::size_t size_;
  std::vector<double> values_;
};

using Column = std::vector<double>;

template <typename Vector>
Column column_of(const Vector& v) {
  return {v.data(), v.data() + v.size()};
}

template <typename Vector>
Vector as_vector(const Column& column) {
  return Eigen::Map<const Vector>(column.data(), static_cast<Eigen::Index>(column.size()));
}

/// P A P^T = L D L^T, the largest of what is left of the diagonal first; a direction in which nothing is left
/// stays where it is, as in Eigen's LDLT.
Column solve_by_ldlt(Square a, const Column& right) {
  const std::size_t n = a.size();
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < n; ++i) {
      if (std::abs(a(i, i)) > std::abs(a(pivot, pivot))) pivot = i;
    }
    a.swap_rows(k, pivot);
    a.swap_columns(k, pivot);
    std::swap(order[k], order[pivot]);
    if (a(k, k) == 0.0) continue;
    for (std::size_t i = k + 1; i < n; ++i) {
      const double share = a(i, k) / a(k, k);
      a.add_row(i, -share, k, k + 1);
      a(i, k) = share;
    }
  }
  Column y(n);
  for (std::size_t i = 0; i < n; ++i) {
    y[i] = right[order[i]];
    for (std::size_t j = 0; j < i; ++j) y[i] -= a(i, j) * y[j];
  }
  for (std::size_t i = 0; i < n; ++i) y[i] = a(i, i) == 0.0 ? 0.0 : y[i] / a(i, i);
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t j = i + 1; j < n; ++j) y[i] -= a(j, i) * y[j];
  }
  Column x(n);
  for (std::size_t i = 0; i < n; ++i) x[order[i]] = y[i];
  return x;
}

/// Gauss-Jordan, the largest of what is left of a column first.
Square inverse_by_elimination(Square a) {
  const std::size_t n = a.size();
  Square inverse = Square::identity(n);
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < n; ++i) {
      if (std::abs(a(i, k)) > std::abs(a(pivot, k))) pivot = i;
    }
    a.swap_rows(k, pivot);
    inverse.swap_rows(k, pivot);
    const double scale = 1.0 / a(k, k);
    for (std::size_t j = 0; j < n; ++j) {
      a(k, j) *= scale;
      inverse(k, j) *= scale;
    }
    for (std::size_t i = 0; i < n; ++i) {
      const double share = i == k ? 0.0 : a(i, k);
      if (share == 0.0) continue;
      a.add_row(i, -share, k, k);
      inverse.add_row(i, -share, k, 0);
    }
  }
  return inverse;
}

/// Turns the axes p and q so that a(p, q) becomes 0; the columns of `vectors` turn along.
void turn_axes(Square& a, Square& vectors, std::size_t p, std::size_t q) {
  const double theta = (a(q, q) - a(p, p)) / (2.0 * a(p, q));
  const double tangent = (theta < 0.0 ? -1.0 : 1.0) / (std::abs(theta) + std::sqrt(theta * theta + 1.0));
  const double c = 1.0 / std::sqrt(tangent * tangent + 1.0);
  const double s = tangent * c;
  const auto turn = [&](double& x, double& y) {
    const double old = x;
    x = c * old - s * y;
    y = s * old + c * y;
  };
  for (std::size_t k = 0; k < a.size(); ++k) {
    turn(a(k, p), a(k, q));
    turn(vectors(k, p), vectors(k, q));
  }
  for (std::size_t k = 0; k < a.size(); ++k) turn(a(p, k), a(q, k));
  a(p, q) = 0.0;
  a(q, p) = 0.0;
}

/// Jacobi's rotations (Golub and Van Loan, Matrix Computations, 8.5): `a` becomes diagonal, the eigenvectors
/// are the columns of what is returned.
Square diagonalise(Square& a) {
  constexpr int kMostSweeps = 40;
  constexpr double kTiny = 1e-36;  // squares: far below what rounding leaves
  const std::size_t n = a.size();
  Square vectors = Square::identity(n);
  for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
    double off = 0.0;
    double all = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) (i == j ? all : off) += a(i, j) * a(i, j);
    }
    if (!(off > kTiny * all)) break;
    for (std::size_t p = 0; p < n; ++p) {
      for (std::size_t q = p + 1; q < n; ++q) {
        if (a(p, q) != 0.0) turn_axes(a, vectors, p, q);
      }
    }
  }
  return vectors;
}

}  // namespace

Spectrum3 spectrum_of(const Matrix3d& symmetric) {
  const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(symmetric);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Spectrum6 spectrum_of(const Matrix6d& symmetric) {
  Square a(symmetric);
  const auto vectors = diagonalise(a).as<Matrix6d>();
  std::vector<std::size_t> order(a.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t i, std::size_t j) { return a(i, i) < a(j, j); });
  Spectrum6 spectrum;
  for (std::size_t k = 0; k < order.size(); ++k) {
    spectrum.values[static_cast<Eigen::Index>(k)] = a(order[k], order[k]);
    spectrum.vectors.col(static_cast<Eigen::Index>(k)) = vectors.col(static_cast<Eigen::Index>(order[k]));
  }
  return spectrum;
}

Vector3d solve_symmetric(const Matrix3d& symmetric, const Vector3d& right) {
  return as_vector<Vector3d>(solve_by_ldlt(Square(symmetric), column_of(right)));
}

Eigen::Vector4d solve_symmetric(const Matrix4d& symmetric, const Eigen::Vector4d& right) {
  return as_vector<Eigen::Vector4d>(solve_by_ldlt(Square(symmetric), column_of(right)));
}

Vector6d solve_symmetric(const Matrix6d& symmetric, const Vector6d& right) {
  return as_vector<Vector6d>(solve_by_ldlt(Square(symmetric), column_of(right)));
}

Eigen::VectorXd solve_symmetric(const Eigen::MatrixXd& symmetric, const Eigen::VectorXd& right) {
  return as_vector<Eigen::VectorXd>(solve_by_ldlt(Square(symmetric), column_of(right)));
}

Matrix3d inverse_of(const Matrix3d& matrix) {
  return matrix.inverse();
}

Matrix4d inverse_of(const Matrix4d& matrix) {
  return matrix.inverse();
}

Matrix6d inverse_of(const Matrix6d& matrix) {
  return inverse_by_elimination(Square(matrix)).as<Matrix6d>();
}

Eigen::MatrixXd inverse_of(const Eigen::MatrixXd& matrix) {
  return inverse_by_elimination(Square(matrix)).as<Eigen::MatrixXd>();
}

double log_determinant_of(const Matrix6d& definite) {
  constexpr double kLeast = 1e-300;  // by rounding what is next to singular may come out below 0
  const Matrix3d first = definite.topLeftCorner<3, 3>();
  const Matrix3d across = definite.topRightCorner<3, 3>();
  const Matrix3d rest =
      definite.bottomRightCorner<3, 3>() - Matrix3d(across.transpose() * inverse_of(first) * across);
  return std::log(std::max(kLeast, first.determinant())) + std::log(std::max(kLeast, rest.determinant()));
}

SingularValues3 singular_values_of(const Matrix3d& matrix) {
  const Eigen::JacobiSVD<Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return {svd.matrixU(), svd.singularValues(), svd.matrixV()};
}

Matrix3d skew(const Vector3d& v) {
  Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

}  // namespace limen
