// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/match/solvers/rotation_from_directions.h"

#include <cmath>

#include "limen/base/error.h"
#include "limen/geometry/linear.h"

namespace limen {
namespace {

/// The orthonormal frame [u q l] of equations 12 to 17.
Matrix3d frame_of(const Vector3d& u, const Vector3d& v) {
  const Vector3d q = v - v.dot(u) * u;  // (12), (13)
  if (q.norm() < 1e-6) {
    throw Error("the wall direction is parallel to the floor direction", "rotation from main directions",
                "give directions that are independent");
  }
  Matrix3d frame;
  frame.col(0) = u;
  frame.col(1) = q.normalized();
  frame.col(2) = u.cross(frame.col(1));  // (14), (15)
  return frame;
}

}  // namespace

Matrix3d rotation_from_main_directions(const MainDirections& source, const MainDirections& target) {
  const Vector3d u1 = source.horizontal;
  const Vector3d u2 = u1.dot(target.horizontal) < 0.0 ? Vector3d(-target.horizontal) : target.horizontal;
  Vector3d v1 = source.vertical_1;
  Vector3d v2 = target.vertical_1;
  for (const Vector3d& a : {source.vertical_1, source.vertical_2}) {
    for (const Vector3d& b : {target.vertical_1, target.vertical_2}) {
      if (std::abs(a.dot(b)) <= std::abs(v1.dot(v2))) continue;  // (11)
      v1 = a;
      v2 = b;
    }
  }
  if (v1.dot(v2) < 0.0) v2 = -v2;
  return frame_of(u2, v2) * frame_of(u1, v1).transpose();  // (16) to (19)
}

RotationFit rotation_from_directions(const std::vector<DirectionPair>& pairs) {
  constexpr double kMinSpreadRad = 0.05;
  Matrix3d correlation = Matrix3d::Zero();
  Matrix3d scatter = Matrix3d::Zero();
  double weight = 0.0;
  for (const DirectionPair& pair : pairs) {
    correlation += pair.weight * pair.target * pair.source.transpose();
    scatter += pair.weight * pair.target * pair.target.transpose();
    weight += pair.weight;
  }
  if (!(weight > 0.0)) {
    throw Error("no pair of directions has a weight", "rotation from directions", "give at least one pair");
  }
  const SingularValues3 svd = singular_values_of(correlation / weight);
  const double sign = svd.left.determinant() * svd.right.determinant() < 0.0 ? -1.0 : 1.0;
  const Vector3d diagonal(1.0, 1.0, sign);
  RotationFit fit;
  fit.rotation = svd.left * diagonal.asDiagonal() * svd.right.transpose();
  // Two target directions at an angle s leave about s^2 / 4 in the second eigenvalue of their scatter.
  const Spectrum3 spread = spectrum_of(Matrix3d(scatter / weight));
  if (spread.values[1] < 0.25 * kMinSpreadRad * kMinSpreadRad) {
    fit.free_axis = spread.vectors.col(2);
  }
  return fit;
}

}  // namespace limen
