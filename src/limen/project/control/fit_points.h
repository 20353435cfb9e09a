// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "limen/project/graph/link_pose.h"

namespace limen {

/// A point in two frames.
struct PointPair {
  Vector3d x_in_source = Vector3d::Zero();
  Matrix3d source_covariance = Matrix3d::Zero();  ///< source axes, m^2
  Vector3d x_in_target = Vector3d::Zero();
  Matrix3d target_covariance = Matrix3d::Zero();  ///< target axes, m^2
};

/// Why points do or do not tell how two frames stand.
enum class PointFitState {
  fixed,         ///< all six freedoms, and what is left out is distinguished from the rest
  too_few,       ///< they leave a freedom open
  contradictory  ///< they contradict one another, and which of them is wrong cannot be decided
};

struct PointFit {
  PointFitState state = PointFitState::too_few;
  /// How the frames stand, where `state` is fixed; its centre is that of the points.
  LinkPose pose;
  std::vector<bool> taken;            ///< of each pair: agrees with the pose
  std::vector<std::size_t> suspects;  ///< where they contradict one another: the pairs that may be wrong
  double chi_square = 0.0;            ///< of those that were taken
  int redundancy = 0;
};

/// A point misses by more than this, three freedoms, once in a thousand by chance.
inline constexpr double kPointChiSquareBound = 16.27;
/// Two explanations whose chi squares are nearer than this (odds of a thousand) are not distinguished.
inline constexpr double kTellingApart = 13.8;

/// Robust rigid fit: of all poses that three pairs give (some hundred, spread evenly, where there are more)
/// the one that most pairs agree with, then least squares over those. Where another set of as many pairs
/// fits nearly as well, the points are contradictory.
PointFit fit_points(const std::vector<PointPair>& pairs);

}  // namespace limen
