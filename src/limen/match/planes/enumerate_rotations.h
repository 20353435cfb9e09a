// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/model/features.h"

namespace limen {

/// A direction shared by planes or segments, sign left open.
struct AxisDirection {
  Vector3d direction = Vector3d::UnitZ();
  double weight = 0.0;  ///< within its set: area of the planes, or length of the segments, that have it
};

struct RotationOptions {
  bool gravity_known = true;
  double gravity_tolerance_deg = 4.0;
  double direction_deg = 5.0;
  double same_rotation_deg = 3.0;  ///< rotations nearer than this are one
};

/// Directions of the planes' normals by weight (area), heaviest first; greedy, each refined as the main
/// eigenvector of its sum of w n n^T (2021, Alg. 1, any number of clusters).
std::vector<AxisDirection> axis_directions(const Features& features, double cluster_deg);

/// All rotations that map two directions of the source onto two of the target with the same angle between
/// them, in every association and sign, refined over all directions that then agree. No two alike.
std::vector<Matrix3d> enumerate_rotations(const std::vector<AxisDirection>& source,
                                          const std::vector<AxisDirection>& target,
                                          const RotationOptions& options);

}  // namespace limen
