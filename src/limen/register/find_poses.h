// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "limen/register/judge/posterior.h"
#include "limen/register/prepare/prepared_pair.h"
#include "limen/register/prepare/stage_clock.h"
#include "limen/register/register.h"

namespace limen {

/// Which of two sides is worked on as the source, whichever a user calls so: the same for both orders, so
/// that swapping the sides turns an answer round and changes nothing else. A model is the target, a scan
/// taken along a path is where the other is not, and else the side of which more surface was seen. What tells
/// two sides apart in the end is their samples, one by one; sides that are the same have no order.
bool is_work_order(const PreparedScan& source, const PreparedScan& target);

/// The sides of a pair in the order in which they are worked on, and whether that is not the order in which
/// they were given.
struct WorkedPair {
  const PreparedScan& source;
  const PreparedScan& target;
  bool turned = false;

  [[nodiscard]] bool has_model() const { return source.model || target.model; }
};

/// `pair` has to outlive it.
WorkedPair worked_pair(const PreparedPair& pair);

/// By what the two sides are: a model, or seen from a station or along a path.
PairSort sort_of(const WorkedPair& pair);

/// A belief about the start between the upright frames, and where it is asked: of the source that was given,
/// whichever is worked on as the source.
struct PreparedStart {
  StartPrior prior;
  Vector3d at = Vector3d::Zero();
  bool upright = false;
  bool turned = false;

  /// A worked pose as it is believed of, and the other way round.
  [[nodiscard]] Rigid3 given(const Rigid3& pose) const { return turned ? inverse(pose) : pose; }
  [[nodiscard]] double log_prior(const Rigid3& pose) const;
};

std::optional<PreparedStart> prepared_start(const WorkedPair& pair, const RegisterOptions& options);

/// What the method refines on, and how near surfaces have to be.
RefineOptions refine_options(const ScanView& source, const ScanView& target, const RegisterOptions& options);

/// Distinct poses of a pair between the upright frames, refined and scored, that of the best value first.
/// Searched first with both scans upright and six freedoms held by three planes or openings; and only where
/// nothing found so exceeds chance, with any tilt, and along planes that leave a shift open.
std::vector<FoundPose> find_poses(const WorkedPair& pair, const RegisterOptions& options, StageClock& clock);

}  // namespace limen
