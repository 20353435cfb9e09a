// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/base/random.h"
#include "limen/geometry/rigid.h"

/// Vectors drawn coordinate by coordinate, the last one first. Numbers drawn as arguments of one call would
/// come in the order that the compiler likes.

namespace limen {

/// Uniform between two corners.
inline Vector2d uniform_vector(const Vector2d& low, const Vector2d& high, RandomStream& random) {
  const double y = random.uniform(low.y(), high.y());
  const double x = random.uniform(low.x(), high.x());
  return {x, y};
}

/// Uniform between two corners.
inline Vector3d uniform_vector(const Vector3d& low, const Vector3d& high, RandomStream& random) {
  const double z = random.uniform(low.z(), high.z());
  const Vector2d xy = uniform_vector(Vector2d(low.head<2>()), Vector2d(high.head<2>()), random);
  return {xy.x(), xy.y(), z};
}

/// Three standard normal numbers.
inline Vector3d normal_vector(RandomStream& random) {
  const double z = random.normal();
  const double y = random.normal();
  const double x = random.normal();
  return {x, y, z};
}

/// Uniform in the ball of radius 1.
inline Vector3d vector_in_ball(RandomStream& random) {
  for (;;) {
    const Vector3d p = uniform_vector(Vector3d(-1.0, -1.0, -1.0), Vector3d(1.0, 1.0, 1.0), random);
    if (p.squaredNorm() <= 1.0) return p;
  }
}

/// Uniform among all rotations.
inline Matrix3d uniform_rotation(RandomStream& random) {
  const double z = random.normal();
  const double y = random.normal();
  const double x = random.normal();
  const double w = random.normal();
  return nearest_rotation(Eigen::Quaterniond(w, x, y, z).normalized().toRotationMatrix());
}

}  // namespace limen
