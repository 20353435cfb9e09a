// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/geometry/linear.h"

namespace limen {

using Matrix63d = Eigen::Matrix<double, 6, 3>;

/// What the tiles of one pair of planes say together, as weighted sums over their rows and residuals. The
/// pair may lie off, and be tilted, as a whole: by an offset and by slopes along two axes of the plane, about
/// the middle of its tiles ("common" below).
struct PlaneSums {
  Matrix6d information = Matrix6d::Zero();
  Matrix63d shared = Matrix63d::Zero();  ///< rows times what moves with the offset and the slopes
  Matrix3d common = Matrix3d::Zero();    ///< the same of these alone
  Vector6d right = Vector6d::Zero();     ///< rows times residuals
  Vector3d residuals = Vector3d::Zero();
  double squares = 0.0;  ///< of the residuals
  double weight = 0.0;
  double counts = 1.0;  ///< as so much of a plane: small ones are often not built as accurately

  [[nodiscard]] double mean_m() const { return residuals[0] / weight; }
  /// All but `weight`. `whole`: what moves the residual with the offset and the slopes.
  void add(const Vector6d& row, double residual_m, const Vector3d& whole, double of_weight) {
    information += of_weight * row * row.transpose();
    shared += of_weight * row * whole.transpose();
    common += of_weight * whole * whole.transpose();
    right += of_weight * residual_m * row;
    residuals += of_weight * residual_m * whole;
    squares += of_weight * residual_m * residual_m;
  }
};

/// By how much a wall differs from the drawing, at least: 1 sigma.
inline constexpr double kLeastBuilderErrsM = 0.002;

/// How far planes err as wholes, one standard deviation.
struct PlaneErrors {
  double offset_m = 0.0;
  double slope = 0.0;
};

/// What a pair says of the pose where it errs as a whole by as much: its offset and slopes, of unknown size,
/// integrated in closed form. `factor`: of the variances that the weights are made with.
Matrix6d information_of(const PlaneSums& plane, const PlaneErrors& errors, double factor);

/// A covariance; a freedom that nothing holds has a deviation of 1000 m or radians.
Matrix6d damped_inverse(const Matrix6d& information);

/// A pose among planes of which some were moved, as a small turn and shift.
struct SettledPose {
  Vector6d step = Vector6d::Zero();
  /// With what other such poses say, weighted by how likely they are.
  Matrix6d information = Matrix6d::Zero();
  std::vector<double> moved;  ///< of each plane, the probability that it was moved
  /// Mean square by which such poses differ from the one next to the pose that was given.
  Matrix6d spread = Matrix6d::Zero();
};

/// The likeliest pose in a building of which each plane either is where the model has it, to the few
/// millimetres that builders err (learned from these planes), or was moved by centimetres, or is another
/// surface that lies near it. Which ones were moved is not known: poses that take other planes for the moved
/// ones are sought too, and how likely they are and how far off is in the information.
/// `stay`: information by which something else keeps the pose where it is.
SettledPose settle_among_moved(const std::vector<PlaneSums>& planes, double slope, double factor,
                               const Matrix6d& stay = Matrix6d::Zero());

}  // namespace limen
