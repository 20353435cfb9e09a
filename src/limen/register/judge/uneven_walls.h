// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "limen/register/prepare/scan_view.h"
#include "limen/register/refine/refine_pose.h"

namespace limen {

/// A wall, floor or ceiling as two scans measured it.
struct CommonPlane {
  Vector3d source_normal = Vector3d::UnitZ();  ///< turned into the target's frame, whose z is up
  Vector3d target_normal = Vector3d::UnitZ();  ///< of the same side
  /// Along the floor and across it within the plane (of a level one: along x and y): how far the shorter of
  /// the two reaches, and what the points' scatter leaves of either normal that way, radians.
  std::array<double, 2> length_m = {1.0, 1.0};
  std::array<double, 2> source_sigma_rad = {0.0, 0.0};
  std::array<double, 2> target_sigma_rad = {0.0, 0.0};
};

/// The large planes that agree under a pose (upright frames), each once, however many pieces it was cut into.
std::vector<CommonPlane> common_planes(const RefinedPose& pose, const ScanView& source,
                                       const ScanView& target);

/// Walls are drawn square and plumb and built askew, by minutes of arc, each in its own way: where both scans
/// see the same walls askew by the same, they saw one room rather than two built to one drawing. By how much
/// that speaks against a twin, natural logarithm: how askew walls are is told by themselves, so that walls
/// that stand as drawn (a simulated building's) say nothing. At most log 20, for one building in twenty
/// repeats its flaws; 0 at least, for surfaces that bend look different from different places, and that
/// speaks for nothing.
double unevenness_nats(std::span<const CommonPlane> planes);

}  // namespace limen
