// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "limen/extract/targets/found_target.h"
#include "limen/io/table/scan_file.h"
#include "limen/project/engine/job_engine.h"
#include "limen/project/inputs/pass_trajectories.h"
#include "limen/register/register.h"

namespace limen {

struct ProjectOptions {
  RegisterOptions registering;
  ReadOptions reading;
  bool all_pairs = false;       ///< every pair is tried, however many there are
  bool stations_apart = false;  ///< scans of one file are not known to one another
  /// Scans of one file are where it has them with this deviation, and not to millimetres.
  std::optional<double> file_sigma_m = {};
  bool rigid_passes = false;   ///< mobile passes do not drift: none is bent
  EngineOptions engine = {};   ///< where features and pairs are made; never changes a result
  TargetOptions targets = {};  ///< found in static scans, and used as if a user had measured them
  /// Along which scans may have been measured: each with times takes the one that covers it, before what its
  /// file says.
  StatedTrajectories trajectories = {};
  /// Gets each note as soon as it is known; all of them are in ProjectResult::notes too.
  std::function<void(const std::string& note)> on_note = {};

  void check() const;
};

/// Scans and models by their files, in any order, and what a surveyor knows (control/control_file.h).
struct ProjectInputs {
  std::vector<std::string> scans;
  std::vector<std::string> models;
  std::string control;  ///< file of points whose coordinates enter as observations; empty: none
  std::string check;    ///< file of points that are compared with the result and never enter
  std::string targets;  ///< file of where the scans saw them, none where they are to be found; a point called
                        ///< as a scan is its scanner's place
  std::string poses;    ///< file of where scans are said to have been (control/control_file.h)
  std::string decisions;  ///< file of what the user says (decide/decisions.h); added to what was said before
};

}  // namespace limen
