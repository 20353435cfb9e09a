// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "limen/model/result.h"
#include "limen/register/judge/found_pose.h"
#include "limen/register/options/pair_options.h"

namespace limen {

/// What a pose leaves open.
struct OpenFreedoms {
  std::vector<UnobservedFreedom> list;
  /// Why, where the matched surface would hold it.
  enum class Cause { surface, drift, moved } cause = Cause::surface;
};

/// Freedoms that the matched surface does not hold, else those that it holds loosely, else those that are
/// loose once what a trajectory may be off by is counted: in `with_drift`, the pose's covariance (turns, then
/// shifts; rad, m); else those that are loose because planes were moved between the scans.
OpenFreedoms open_freedoms(const RefinedPose& pose, const Matrix6d& with_drift,
                           const VerdictOptions& options = {});

/// Whether two poses differ only along shifts that the matched surface leaves open under the first.
bool is_slid(const RefinedPose& first, const RefinedPose& second, const VerdictOptions& options = {});

/// Distinct poses, best value first: indices. A belief about the start counts as the surface that would tell
/// as much.
std::vector<std::size_t> rank(const std::vector<FoundPose>& poses, const VerdictOptions& options = {});

/// Freedoms of a pose that less than `min_held_m2` of matched surface holds.
std::vector<UnobservedFreedom> unobserved_freedoms(const RefinedPose& pose, double min_held_m2);

/// Freedoms that are held, but less well than the bounds ask for: by far-off or hardly seen openings, say, or
/// by a trajectory that drifts. `covariance` of a pose: turns, then shifts (rad, m). The name tells how well.
std::vector<UnobservedFreedom> loose_freedoms(const Matrix6d& covariance, double max_sigma_m,
                                              double max_sigma_deg);

}  // namespace limen
