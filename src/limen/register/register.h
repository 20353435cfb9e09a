// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "limen/base/progress.h"
#include "limen/extract/features/extract_features.h"
#include "limen/match/planes/enumerate_poses.h"
#include "limen/model/bim_model.h"
#include "limen/model/method.h"
#include "limen/model/result.h"
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

struct PreparedPair;

/// The part behind the door: everything but the features, so that a scan is prepared once for many partners
/// or methods.
RegistrationResult register_prepared(const PreparedPair& pair, const RegisterOptions& options = {},
                                     Monitor& monitor = silent_monitor());

/// One side of a registration: one or more scans that are known to one another, or a building model.
struct RegisterInput {
  std::vector<PlacedScan> scans;
  std::optional<BimModel> model;
};

/// Registers scans with scans or with a model, either way round, for any starting pose: the one-call door.
/// Where the planes of a scan propose no place at all in a model, its edges do (2023, IV).
/// Throws Error where both sides are models or one is empty.
RegistrationResult register_inputs(const RegisterInput& source, const RegisterInput& target,
                                   const RegisterOptions& options = {}, Monitor& monitor = silent_monitor());

/// Reads one side when its turn has come; called a second time only where a model is sought by its edges as
/// well.
using InputReader = std::function<RegisterInput()>;

/// The same of sides that are given up once they lie in their frames: of two very large scans only one lies
/// in memory at a time.
RegistrationResult register_inputs(const InputReader& source, const InputReader& target,
                                   const RegisterOptions& options = {}, Monitor& monitor = silent_monitor());

/// Registers two scans by planar polygons (2021), openings (2022) or both (2023), for any starting pose.
/// Poses are between the scans' world coordinates: x_target = target_from_source * x_source.
RegistrationResult register_scans(const Scan& source, const Scan& target, const RegisterOptions& options = {},
                                  Monitor& monitor = silent_monitor());

/// The same of points alone, metres, each list in a frame of its own; where they were seen from is estimated.
RegistrationResult register_scans(std::vector<Vector3d> source, std::vector<Vector3d> target,
                                  const RegisterOptions& options = {}, Monitor& monitor = silent_monitor());

/// Finds a scan in a building model by its planes, or its line segments (2023, IV).
RegistrationResult register_to_model(const Scan& scan, const BimModel& model,
                                     const RegisterOptions& options = {},
                                     Monitor& monitor = silent_monitor());

}  // namespace limen
