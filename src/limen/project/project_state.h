// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "limen/project/control/control_file.h"
#include "limen/project/engine/job_engine.h"
#include "limen/project/graph/pose_query.h"
#include "limen/project/project.h"
#include "limen/project/store/store.h"

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
  std::optional<SurveyedPoint> stated;  ///< where its scanner is said to have been, about

  /// By how much points of a mobile scan stray for its trajectory, one standard deviation per axis; metres.
  [[nodiscard]] double strays_m() const { return drift ? drift->strays_m : digest.drift_m; }
};

/// A pair that was tried, with what came of it; nodes by number, source > target.
struct TriedPair {
  std::size_t source = 0;
  std::size_t target = 0;
  RegistrationResult result;
  std::string fault = {};  ///< why there is no result, where a worker could not make it; empty: there is one
};

struct UserWords;

/// Writes how far the project is to the store, for `project status`.
void write_status(const std::filesystem::path& folder, const ProjectStatus& status);

/// How far a pair is searched.
enum class PairSearch {
  level,     ///< two scans that stand upright are taken to do so
  any_turn,  ///< where nothing is found so, they may stand any way round
};

/// Whether the two ways to search differ: both scans seem to stand upright, and nobody said so.
bool seem_level(const ProjectNode& source, const ProjectNode& target, const RegisterOptions& options);

/// Where and how pairs are registered.
struct PairWork {
  const std::vector<ProjectNode>& nodes;
  const std::vector<ProjectScan>& scans;
  const Store& store;
  const RegisterOptions& options;
  JobEngine* engine;  ///< null: here
  const std::filesystem::path& folder;
};

/// Registers the pairs whose result is not kept, several at a time; returns all results in the given order.
std::vector<TriedPair> try_pairs(const std::vector<std::pair<std::size_t, std::size_t>>& pairs,
                                 const PairWork& work, PairSearch search, ProjectStatus& status,
                                 Monitor& monitor);

/// The frame, the states and the words (`bounds`: what a scan reported as registered, or as probable, may be
/// wrong with): everything of `result` but its scans' files. `query`: what scans say of places that no pair
/// proposed. Throws Error where a file of the survey is no good.
void assemble(const std::vector<ProjectNode>& nodes, const std::vector<TriedPair>& pairs,
              const ProjectInputs& inputs, const UserWords& words, const VerdictOptions& bounds,
              const PoseQuery& query, ProjectResult& result);

}  // namespace limen
