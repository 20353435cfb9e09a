// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "limen/geometry/rigid.h"

namespace limen {

/// The main directions of one scan (unit vectors): of its floors and of two families of walls.
struct MainDirections {
  Vector3d horizontal = Vector3d::UnitZ();
  Vector3d vertical_1 = Vector3d::UnitX();
  Vector3d vertical_2 = Vector3d::UnitY();
};

/// The rotation of Djahel, Monasse, Vallet 2021, section 3.3, equations 11 to 19: exact on the horizontal
/// directions and on the projection of the best-agreeing pair of walls, for a start that is already near.
///
/// Departures from the printed text: equation 11 takes the pair of largest |v1 . v2| (as printed it picks
/// opposed vectors) and aligns its sign, as well as the sign of the horizontal directions; the last factor of
/// 12 and 13 is the vector u; q is normalised, without which R is not orthonormal.
/// Throws Error where a wall's direction is parallel to the horizontal planes' one.
Matrix3d rotation_from_main_directions(const MainDirections& source, const MainDirections& target);

/// Two directions that shall coincide; signs matter.
struct DirectionPair {
  Vector3d source = Vector3d::UnitX();  ///< unit
  Vector3d target = Vector3d::UnitX();  ///< unit
  double weight = 1.0;                  ///< >= 0
};

struct RotationFit {
  Matrix3d rotation = Matrix3d::Identity();  ///< target_from_source, determinant +1
  /// Set where all directions are parallel (within 0.05 rad): the turn about it is not held.
  std::optional<Vector3d> free_axis;
};

/// Least squares over all pairs: the rotation that minimises the sum of w |R s - t|^2 (Wahba 1965, solved by
/// singular value decomposition after Markley 1988). Throws Error without any pair of positive weight.
RotationFit rotation_from_directions(const std::vector<DirectionPair>& pairs);

}  // namespace limen
