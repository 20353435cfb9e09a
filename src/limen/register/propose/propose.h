// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/match/planes/enumerate_poses.h"
#include "limen/model/features.h"
#include "limen/model/method.h"

namespace limen {

/// Which side is a building model.
enum class ModelSide { none, source, target };

struct ProposalOptions {
  Method method = Method::automatic;
  PoseEnumerationOptions planes;
  double wall_thickness_m = 0.0;  ///< as the user knows it; 0: not known
  ModelSide model = ModelSide::none;
  bool thorough = true;  ///< false: in a model the few largest planes of each direction are tried
};

/// Poses of the source in the target, local frames, from everything the method allows. The order means
/// nothing across methods: score them all.
std::vector<PoseCandidate> propose_poses(const Features& source, const Features& target,
                                         const ProposalOptions& options);

/// Poses that leave one shift open, for scans that share too few planes.
std::vector<PoseCandidate> propose_sliding_poses(const Features& source, const Features& target,
                                                 const ProposalOptions& options);

}  // namespace limen
