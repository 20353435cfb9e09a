// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/geometry/rigid.h"

namespace limen {

/// A point and how well it is known.
struct MeasuredPoint {
  Vector3d x = Vector3d::Zero();  ///< metres, about an origin nearby
  double sigma_m = 0.001;
};

/// Which of the `known` points each of the `seen` ones is, by the distances between them: an index, or -1.
/// The largest set that one rigid motion carries over. All -1 where it has fewer than three points or they
/// lie on a line, where another set is as large, or where so few would fit by chance.
std::vector<int> match_points(const std::vector<MeasuredPoint>& seen,
                              const std::vector<MeasuredPoint>& known);

}  // namespace limen
