// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <vector>

#include "limen/geometry/rigid.h"

namespace limen {

/// A translation by least squares, and what holds it.
struct TranslationFit {
  Vector3d translation = Vector3d::Zero();  ///< of target_from_source, metres
  double rms_m = 0.0;                       ///< weighted root mean square distance that is left
  /// Condition of the system (ratio of its largest to its smallest singular value): 1 where all directions
  /// are held alike, infinite where one is not held at all.
  double condition = std::numeric_limits<double>::infinity();
  std::vector<Vector3d> unobserved;  ///< unit directions, target frame; along them `start` is kept
};

/// Normal equations of a translation, metres: sums over pairs, whatever is paired.
struct TranslationSums {
  Matrix3d information = Matrix3d::Zero();  ///< of weight times the projection on what a pair measures
  Vector3d right_side = Vector3d::Zero();   ///< of weight times that projection of the gap left at `start`
  double weight = 0.0;
};

/// The least-squares translation near `start`; `rms_m` is left to the caller. A direction is held when its
/// share of the information (eigenvalue of information / weight) exceeds `min_information`.
TranslationFit solve_translation(const TranslationSums& sums, const Vector3d& start, double min_information);

}  // namespace limen
