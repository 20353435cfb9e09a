// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "limen/project/adjust/survey_point.h"

namespace limen {

/// What three coordinates may miss by, and what is found.
struct PointBounds {
  double squared = 0.0;  ///< chi square of three freedoms above which something is wrong
  double shift = 0.0;    ///< in standard deviations: a blunder of this size is found with 80 %
};
/// For so many tests at a time: a false alarm once in a thousand tests, and once in a hundred times all of
/// them.
PointBounds point_bounds(std::size_t tests);

/// How far three coordinates are from what everything else makes of them (Baarda 1968; Teunissen, Testing
/// Theory, 2006, 3.3): the test of one observation of three numbers.
struct PointTest {
  Vector3d residual = Vector3d::Zero();  ///< observed less adjusted, metres
  Vector3d sigma = Vector3d::Zero();     ///< of the residual, one standard deviation
  Vector3d w = Vector3d::Zero();         ///< each axis: the w-test, in standard deviations
  double squared = 0.0;                  ///< chi square of three freedoms that a blunder would explain
  double redundancy = 0.0;               ///< how many of the three numbers others check, 0 .. 3
  /// A blunder along an axis that is found with 80 %, metres; infinite: nothing checks this axis.
  Vector3d detectable = Vector3d::Constant(std::numeric_limits<double>::infinity());
};

/// A point after the adjustment.
struct PointFinding {
  Vector3d x = Vector3d::Zero();           ///< by all that entered for it, frame
  Matrix3d covariance = Matrix3d::Zero();  ///< m^2
  PointTest known;                         ///< of its coordinates, where they entered
  std::vector<PointTest> sights;           ///< of each sight, where the point entered
};

/// `sight_covariance` as JointSolution tells it for the point; `shift` as in PointBounds.
PointFinding test_point(const MarkedPoint& point, const std::vector<Rigid3>& frame_from_node,
                        const Eigen::MatrixXd& sight_covariance, double shift);

/// The squared deviations by which `given` misses a finding that it did not enter.
double missed_squared(const PointFinding& predicted, const KnownPlace& given);

}  // namespace limen
