// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "limen/extract/features/extract_features.h"
#include "limen/match/planes/enumerate_poses.h"
#include "limen/model/method.h"
#include "limen/register/options/pair_options.h"

namespace limen {

/// Feature options for registration: small planes too, for they may hold the one shift that large ones leave
/// open.
ExtractOptions features_for_registration();

struct RegisterOptions {
  Method method = Method::automatic;
  std::optional<PublishedMethod> as_published = {};  ///< this paper's own method instead (published/)
  Gravity gravity = Gravity::automatic;
  double wall_thickness_m = 0.0;  ///< of the outer walls, as the user knows it; 0: not known
  std::uint64_t seed = 1;         ///< of what is drawn: by msac, scan_lines, and published methods
  ExtractOptions extract = features_for_registration();
  PoseEnumerationOptions enumerate;
  RefineOptions refine;
  VerdictOptions verdict;
  std::optional<StartPrior> start = {};  ///< what is believed of the pose beforehand, world to world
  bool nothing_repeats = false;          ///< a user says so of the building's rooms, flats and storeys
  int refined_poses = 32;                ///< candidates that are refined and judged
  int alternatives = 8;                  ///< different poses reported besides the best
  bool picture = false;                  ///< keep what a report draws

  void check() const;
};

struct PrepareOptions;
/// How the scans of a pair are to be prepared.
PrepareOptions prepare_options(const RegisterOptions& options);

}  // namespace limen
