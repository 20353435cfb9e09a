// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <vector>

#include "limen/match/planes/enumerate_poses.h"
#include "limen/model/features.h"
#include "limen/model/method.h"
#include "limen/register/judge/score_pose.h"

namespace limen {

/// A comparison of many poses: on few samples a single one that seems contradicted represents many square
/// metres, so it must not weigh as much as later.
struct Look {
  std::size_t samples = 0;  ///< asked of each scan, about
  std::size_t most = 0;     ///< poses kept
  double contradiction_weight = kContradictionWeight;
  bool openings = true;
  bool ask_model = true;   ///< the scan is asked about a model's surface as well
  double min_share = 0.0;  ///< of the best value: poses below are not kept ...
  std::size_t least = 24;  ///< ... but at least so many: they show what chance reaches
  double clear_m2 = -std::numeric_limits<double>::infinity();  ///< and only where the best reaches this
};

/// The candidates that explain the scans best, best first.
std::vector<PoseCandidate> best_of(const std::vector<PoseCandidate>& candidates, const ScanView& source,
                                   const ScanView& target, const Look& look);

/// The same in several looks, each closer and at fewer poses, until about `most` are left.
std::vector<PoseCandidate> select_poses(const std::vector<PoseCandidate>& candidates, const ScanView& source,
                                        const ScanView& target, std::size_t most, bool openings);

inline constexpr std::size_t kSecondLook = 4000;  ///< samples asked of each scan when hundreds are compared

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
