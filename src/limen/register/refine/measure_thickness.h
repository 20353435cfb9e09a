// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/model/features.h"
#include "limen/model/result.h"
#include "limen/register/refine/refine_pose.h"

namespace limen {

/// The thickness of every wall whose two faces matched openings bring together: the distance of the faces
/// under the pose, at the openings (2023, III-B, with the thickness measured instead of taken for zero). Its
/// deviation is that of the pose along the wall's normal and of the two planes; where planes, reveals or the
/// user fix the pose there, it is small, and where nothing does it says so.
std::vector<MeasuredThickness> measure_thickness(const RefinedPose& pose, const Features& source,
                                                 const Features& target);

}  // namespace limen
