// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/match/openings/enumerate_opening_poses.h"

namespace limen {

/// The poses by their distance, lowest first, without those that are nearly a better one: turned by less than
/// a degree, and at `middle` (a point of the source) shifted by less than `kSameInWallM` within the wall and
/// `kSameAcrossWallM` across it.
std::vector<OpeningPose> distinct_poses(std::vector<OpeningPose> poses, const Vector3d& middle);

}  // namespace limen
