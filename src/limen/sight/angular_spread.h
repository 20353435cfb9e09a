// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "limen/geometry/rigid.h"

namespace limen {

/// How the points of a static scan spread over the directions seen from a place.
struct AngularSpread {
  /// Kullback-Leibler divergence of the points' directions from a uniform distribution over the field of
  /// view, nats per point. A scanner measures in even angular steps, so it is least where the scanner was.
  double divergence = 0.0;
  double hidden = 0.0;  ///< share of the points that lie behind others: from the scanner next to none do
};

/// Directions are counted in the cells of a cube's six faces, `cells` along a side. 20,000 points that are
/// spread over the scan tell enough.
AngularSpread angular_spread(const std::vector<Vector3d>& points, const Vector3d& place, std::size_t cells);

/// As many cells along a side that some points fall into each cell of the field of view from `place`.
std::size_t direction_cells(const std::vector<Vector3d>& points, const Vector3d& place);

/// By how much the best of some hundred places within 8 m of `claim` fits the points better as the scanner's
/// position, nats per point: the divergence with half of what is hidden. A place from which clearly more is
/// hidden than from the claim does not count. 0 where none fits better. Of true positions of real
/// scans it is at most 0.03, of positions 2 to 8 m off half reach 0.4.
double better_place_nearby(const std::vector<Vector3d>& points, const Vector3d& claim);

}  // namespace limen
