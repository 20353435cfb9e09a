// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/model/result.h"
#include "limen/report/html/html_scene.h"

namespace limen {

/// How a report looks at a scene. All in the target's local frame.
struct SceneView {
  /// Rows: to the right in the plan, upwards in the plan, towards the zenith; along the building's walls.
  Matrix3d view_from_target = Matrix3d::Identity();
  Vector3d low = Vector3d::Zero();   ///< box around what both sides show, view coordinates, metres
  Vector3d high = Vector3d::Zero();  ///< its other corner
  Vector3d cut = Vector3d::Zero();   ///< where the sections are taken, view coordinates
  Rigid3 target_from_source;         ///< best pose between the local frames; for no_match side by side
  bool matched = false;              ///< there is a pose at all
};
SceneView make_view(const ReportScene& scene, const RegistrationResult& result);

}  // namespace limen
