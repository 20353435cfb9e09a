// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "limen/geometry/rigid.h"
#include "limen/match/solvers/translation_fit.h"

// Djahel, Monasse, Vallet, "Detecting openings for indoor/outdoor registration", 2022, section 3.3, equations
// 15 to 19 (Monasse, Djahel, Vallet 2023, section IV-D, equations 10 to 14, is the same): the rigid motion
// that lays lines of one scan on lines of another.
//
// Departures from the printed text:
// - O is orthonormal, so its inverse in (16) is its transpose;
// - p_i of (18) is a point of the source that has already been turned; here the solver turns it;
// - any number of pairs with weights instead of two;
// - M of (19) is singular where all lines are parallel: a direction that the lines do not hold is named, and
//   along it the start is kept;
// - a wall's normal can be left out of a pair, so that the thickness of the wall is not asked to be zero.

namespace limen {

/// A line; its direction's sign matters for rotations only.
struct Line {
  Vector3d point = Vector3d::Zero();       ///< metres
  Vector3d direction = Vector3d::UnitX();  ///< unit
};

/// A line of the source that shall lie on a line of the target.
struct LinePair {
  Line source;
  Line target;
  double weight = 1.0;                  ///< >= 0
  std::optional<Vector3d> wall_normal;  ///< unit, target frame: distances along it do not count
};

/// Equations 15 and 16: the rotation that lays `vertical` exactly on its partner and `horizontal` as nearly
/// as that allows. Throws Error where the two are parallel in one of the scans.
Matrix3d rotation_from_lines(const LinePair& vertical, const LinePair& horizontal);

/// Equations 17 to 19: the shift that brings the turned points of the source's lines nearest to the target's
/// lines. A direction is held when its share of the information (eigenvalue of the weighted mean of
/// [d]x^t [d]x) exceeds `min_information`.
TranslationFit translation_from_lines(const Matrix3d& target_from_source_rotation,
                                      const std::vector<LinePair>& pairs,
                                      const Vector3d& start = Vector3d::Zero(),
                                      double min_information = 0.003);

/// Both steps for the papers' two pairs. Throws Error where the two lines of a scan are parallel.
Rigid3 rigid_from_lines(const LinePair& vertical, const LinePair& horizontal);

}  // namespace limen
