// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/match/enumerate_poses.h"
#include "limen/model/features.h"

namespace limen {

/// What poses are proposed from.
enum class Method {
  automatic,  ///< all there is
  polygons,   ///< planar polygons (2021)
  openings,   ///< openings (2022)
  hybrid,     ///< openings, and planes for the shift across the wall (2023, III)
  segments    ///< line segments (2023, IV)
};
const char* to_string(Method method);

/// Which side is a building model.
enum class ModelSide { none, source, target };

struct ProposalOptions {
  Method method = Method::automatic;
  PoseEnumerationOptions planes;
  double wall_thickness_m = 0.0;  ///< as the user knows it; 0: not known
  ModelSide model = ModelSide::none;
};

/// Poses of the source in the target, local frames, from everything the method allows. The order means
/// nothing across methods: score them all.
std::vector<PoseCandidate> propose_poses(const Features& source, const Features& target,
                                         const ProposalOptions& options);

/// Poses that leave one shift open, for scans that share too few planes.
std::vector<PoseCandidate> propose_sliding_poses(const Features& source, const Features& target,
                                                 const ProposalOptions& options);

}  // namespace limen
