// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/register/judge/model_walls.h"
#include "limen/register/judge/score_pose.h"
#include "limen/register/refine/refine_pose.h"

namespace limen {

/// A refined pose with its final score, upright frames.
struct FoundPose {
  RefinedPose refined;
  PoseScore score;
  WallBalance walls;       ///< of a scan in a model
  double log_prior = 0.0;  ///< by how much a belief about the start makes it more probable, nats
};

}  // namespace limen
