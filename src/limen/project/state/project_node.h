// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "limen/model/result.h"
#include "limen/project/control/control_file.h"
#include "limen/project/graph/link_pose.h"
#include "limen/project/store/scan_digest.h"

namespace limen {

/// The slow error of a pass's trajectory, as what it sees at several times shows it (learn_own_drift).
struct OwnDrift {
  double strays_m = 0.0;              ///< from the pass as a rigid body, one standard deviation per axis
  double turn_rate_rad2_per_m = 0.0;  ///< of the random walk of turns along the way
};

/// One scan or model of a run, with its digest.
struct ProjectNode {
  std::size_t scan = 0;  ///< index into ProjectResult::scans
  std::size_t file = 0;  ///< number of its file
  std::string key;       ///< of its features
  ScanDigest digest;
  bool grouped = false;                 ///< its file holds several scans that are known to one another
  std::optional<OwnDrift> drift;        ///< of a pass that can be bent
  std::optional<SurveyedPoint> stated;  ///< where its scanner is said to have been, about ...
  double reach_m = 0.0;                 ///< ... and how far its planes reach from there, no less

  /// By how much points of a mobile scan stray for its trajectory, one standard deviation per axis; metres.
  [[nodiscard]] double strays_m() const { return drift ? drift->strays_m : digest.drift_m; }
};

/// A pair that was tried, with what came of it; nodes by number, source > target.
struct TriedPair {
  std::size_t source = 0;
  std::size_t target = 0;
  RegistrationResult result;
  std::string fault = {};  ///< why there is no result, where a worker could not make it; empty: there is one
  /// Where the links place the two, of a pair that was measured once more from there.
  std::optional<LinkPose> placed = {};
};

}  // namespace limen
