// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "limen/model/registration_picture.h"
#include "limen/register/register.h"

namespace limen {

/// Corners of a flat piece of a model, counter-clockwise from its front.
using Triangle3 = std::array<Vector3d, 3>;

/// One side of a registration as a report draws it; everything about `origin`, metres.
struct SceneSide {
  Vector3d origin = Vector3d::Zero();  ///< world = origin + x
  std::vector<Vector3d> points;        ///< thinned
  std::vector<std::uint8_t> colours;   ///< 3 per point (red, green, blue) or empty
  std::vector<float> intensities;      ///< per point or empty, in the file's unit
  std::vector<Triangle3> faces;        ///< of a model, large ones first
  PicturedSide pictured;               ///< planes, openings, segments
};

/// Both sides of a registration.
struct ReportScene {
  SceneSide source;
  SceneSide target;
};

/// What a report draws of scans or a model besides what was found in them: their points, thinned evenly over
/// the surface, or faces. About the first scan's local origin, or the model's.
SceneSide scene_side(const RegisterInput& input, std::size_t max_points = 300000);

/// The side about the origin of what was found in it, and this.
SceneSide with_picture(SceneSide side, const PicturedSide& pictured);

}  // namespace limen
