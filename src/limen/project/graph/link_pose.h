// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <Eigen/Core>

#include "limen/geometry/rigid.h"
#include "limen/model/look_alike_evidence.h"
#include "limen/model/result.h"

namespace limen {

/// A measured pose between two nodes and how well it is known. Both frames are about local origins.
struct LinkPose {
  Rigid3 target_from_source;
  /// Of a small motion (turn about `centre` in radians, shift in metres) after the pose; target axes, SI.
  Matrix6d covariance = Matrix6d::Identity();
  Vector3d centre = Vector3d::Zero();  ///< near the common surface, target frame, metres
  double agreeing_m2 = 0.0;            ///< surface that supports it
  double probability = 1.0;            ///< that it is the right one, by the pair alone
  /// Whether it lays a place on a look-alike one, where that was asked.
  std::optional<LookAlikeEvidence> look_alike = {};
};

/// The same pose the other way round.
LinkPose reversed(const LinkPose& pose);

/// Covariance of the same small motion in another frame, about the point `at` of that frame.
Matrix6d moved_covariance(const LinkPose& pose, const Rigid3& b_from_target, const Vector3d& at);

/// The small motion (turn, shift of the centre) that leads from the measured pose to `predicted`; target
/// axes.
Vector6d misfit(const LinkPose& measured, const Rigid3& predicted);

/// Whether a misfit is so small that it leads to no other place.
bool is_one_place(const Vector6d& misfit);

/// Squared length of a misfit in standard deviations.
double chi_square(const Vector6d& misfit, const Matrix6d& covariance);

/// A loop or a link with more than this (six freedoms, once in a thousand by chance) does not close.
inline constexpr double kChiSquareBound = 22.46;

}  // namespace limen
