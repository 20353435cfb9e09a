// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/geometry/rotation_between.h"

#include <cmath>

namespace limen {

Matrix3d rotation_between(const Vector3d& from, const Vector3d& to) {
  constexpr double kOpposite = 1e-12;
  const Vector3d a = from.normalized();
  const Vector3d b = to.normalized();
  const double cosine = b.dot(a);
  Eigen::Quaterniond turn;
  if (1.0 + cosine > kOpposite) {
    const double twice = std::sqrt((1.0 + cosine) * 2.0);
    turn.vec() = a.cross(b) / twice;
    turn.w() = 0.5 * twice;
  } else {
    turn.vec() = a.unitOrthogonal();
    turn.w() = 0.0;
  }
  return turn.normalized().toRotationMatrix();
}

}  // namespace limen
