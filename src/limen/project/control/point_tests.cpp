// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/control/point_tests.h"

#include <algorithm>
#include <cmath>

#include "limen/geometry/linear.h"

namespace limen {
namespace {

constexpr double kPerTest = 1e-3;          // probability of a false alarm of one test ...
constexpr double kPerAll = 1e-2;           // ... and of any of them
constexpr double kPower = 0.8;             // probability that a detectable blunder is found
constexpr double kLeastRedundancy = 1e-3;  // of an axis: below this nothing checks it

/// Probability that the squared length of three normal numbers, one of which is shifted by `shift`, exceeds
/// `squared` (noncentral chi square, closed for three freedoms).
double exceeded(double squared, double shift) {
  const double root = std::sqrt(squared);
  const auto tail = [](double x) { return 0.5 * std::erfc(x / std::sqrt(2.0)); };
  const auto density = [](double x) { return std::exp(-0.5 * x * x) / std::sqrt(8.0 * std::atan(1.0)); };
  const double sides = tail(root - shift) + tail(root + shift);
  if (shift < 1e-6) return sides + 2.0 * root * density(root);
  return sides + (density(root - shift) - density(root + shift)) / shift;
}

/// Where a function that grows crosses zero.
template <typename Function>
double crossing(double low, double high, const Function& function) {
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    (function(middle) < 0.0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// `weight`: inverse of the observation's covariance; `adjusted`: covariance of its adjusted value.
PointTest test_of(const Vector3d& residual, const Matrix3d& weight, const Matrix3d& adjusted, double shift) {
  PointTest test;
  test.residual = residual;
  const Matrix3d of_residual = inverse_of(weight) - adjusted;
  test.redundancy = std::clamp((of_residual * weight).trace(), 0.0, 3.0);
  const Matrix3d reduced = weight * of_residual * weight;
  const Vector3d pull = weight * residual;
  for (Eigen::Index k = 0; k < 3; ++k) {
    test.sigma[k] = std::sqrt(std::max(0.0, of_residual(k, k)));
    if (reduced(k, k) <= kLeastRedundancy * weight(k, k)) continue;
    const double root = std::sqrt(reduced(k, k));
    test.w[k] = pull[k] / root;
    test.detectable[k] = shift / root;
  }
  // In axes of one standard deviation; what nothing checks is left out.
  const Spectrum3 root = spectrum_of(weight);
  const Matrix3d half =
      root.vectors * root.values.cwiseMax(0.0).cwiseSqrt().asDiagonal() * root.vectors.transpose();
  const Spectrum3 checked = spectrum_of(Matrix3d(half * of_residual * half));
  const Vector3d along = checked.vectors.transpose() * (half * residual);
  for (Eigen::Index k = 0; k < 3; ++k) {
    if (checked.values[k] > kLeastRedundancy) test.squared += along[k] * along[k] / checked.values[k];
  }
  return test;
}

}  // namespace

PointBounds point_bounds(std::size_t tests) {
  const double chance = std::min(kPerTest, kPerAll / static_cast<double>(std::max<std::size_t>(1, tests)));
  PointBounds bounds;
  bounds.squared = crossing(1.0, 200.0, [&](double squared) { return chance - exceeded(squared, 0.0); });
  bounds.shift = crossing(0.0, 40.0, [&](double shift) { return exceeded(bounds.squared, shift) - kPower; });
  return bounds;
}

PointFinding test_point(const MarkedPoint& point, const std::vector<Rigid3>& frame_from_node,
                        const Eigen::MatrixXd& sight_covariance, double shift) {
  PointFinding finding;
  if (point.sights.empty()) return finding;
  const PointTerms terms = point_terms(point, frame_from_node);
  const Matrix3d inverted = inverse_of(terms.own);
  Eigen::Matrix<double, 3, Eigen::Dynamic> pull(3, sight_covariance.cols());
  for (std::size_t i = 0; i < point.sights.size(); ++i)
    pull.middleCols<3>(static_cast<Eigen::Index>(3 * i)) = inverted * terms.weight[i];
  // x follows the poses by `pull`, and what it is by its own sights is known to `inverted`.
  finding.x = terms.x;
  finding.covariance = inverted + pull * sight_covariance * pull.transpose();
  if (!point.enters) return finding;
  if (point.is_known())
    finding.known =
        test_of(point.known->x - terms.x, inverse_of(point.known->covariance), finding.covariance, shift);
  for (std::size_t i = 0; i < point.sights.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(3 * i);
    const Matrix3d mixed = sight_covariance.middleRows<3>(at) * pull.transpose();
    const Matrix3d adjusted =
        sight_covariance.block<3, 3>(at, at) + finding.covariance - mixed - mixed.transpose();
    finding.sights.push_back(test_of(terms.place[i] - terms.x, terms.weight[i], adjusted, shift));
  }
  return finding;
}

double missed_squared(const PointFinding& predicted, const KnownPlace& given) {
  const Vector3d missed = given.x - predicted.x;
  const Matrix3d covariance = given.covariance + predicted.covariance;
  return missed.dot(solve_symmetric(covariance, missed));
}

}  // namespace limen
