// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/model/method.h"
#include "limen/register/judge/look_alike_odds.h"
#include "limen/register/judge/score_pose.h"
#include "limen/register/prepare/prepare_scan.h"

namespace limen {

/// By how far the trajectories of both may be off, one standard deviation.
double drift_m(const ScanView& source, const ScanView& target);

/// Tolerances of the final score, from the noise of the scans and the error of their trajectories.
ScoreOptions fine_score(const ScanView& source, const ScanView& target, Method method);

/// What two scans say of a pose that nobody searched for (world to world, the scans' own axes): as a pair's
/// pose is scored in the end, and not refined. `uncertainty_m`: how well the pose is known where the scans
/// see the same, one standard deviation.
PoseScore score_given_pose(const PreparedScan& source, const PreparedScan& target,
                           const Rigid3& target_from_source, Method method = Method::automatic,
                           double uncertainty_m = 0.0);

/// What things say there of whether the scans show one room, or two built alike.
LookAlikeEvidence look_alike_of_given_pose(const PreparedScan& source, const PreparedScan& target,
                                           const Rigid3& target_from_source,
                                           const LookAlikeOptions& options = {});

}  // namespace limen
