// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/geometry/polygon.h"
#include "limen/match/solvers/translation_fit.h"

namespace limen {

/// A plane of the source that shall lie on a plane of the target.
struct PlanePair {
  /// On the source's plane where the two overlap (or its centroid).
  Vector3d source_point = Vector3d::Zero();
  Plane target;
  double weight = 1.0;  ///< >= 0; for example the area in common
};

/// Djahel, Monasse, Vallet 2021, section 3.4, equations 20 to 22: the shift that lays the turned source
/// planes on the target planes, N_l . (R p_l + T) = d_l, by least squares over any number of pairs.
///
/// Departures from the printed text: its equation 21 holds for n . x + d = 0, here n . x = offset; the offset
/// of the source plane is taken at a point of it instead of at the frame's origin, so that normals which
/// differ by noise do not act over a lever of the coordinates' size; signs of normals then do not matter;
/// directions that the planes do not hold are named and left as in `start`.
TranslationFit translation_from_planes(const Matrix3d& target_from_source_rotation,
                                       const std::vector<PlanePair>& pairs,
                                       const Vector3d& start = Vector3d::Zero());

}  // namespace limen
