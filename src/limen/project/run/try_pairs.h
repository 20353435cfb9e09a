// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <utility>
#include <vector>

#include "limen/base/progress.h"
#include "limen/project/engine/job_engine.h"
#include "limen/project/graph/pose_query.h"
#include "limen/project/result/project_result.h"
#include "limen/project/run/store_jobs.h"
#include "limen/project/state/project_node.h"
#include "limen/project/state/project_status.h"
#include "limen/project/state/words.h"
#include "limen/project/store/store.h"
#include "limen/register/register.h"

namespace limen {

/// Asks pairs of static scans; of others, and where two do not meet, nothing is answered. Keeps references.
PoseQuery query_of_scans(const std::vector<ProjectNode>& nodes, const RegisterOptions& options,
                         ScanCache& cache);

/// How far a pair is searched.
enum class PairSearch {
  level,     ///< two scans that stand upright are taken to do so
  any_turn,  ///< where nothing is found so, they may stand any way round
};

/// Whether the two ways to search differ: both scans seem to stand upright, one of them not surely, and
/// nobody said so.
bool seem_level(const ProjectNode& source, const ProjectNode& target, const RegisterOptions& options);

/// Where and how pairs are registered.
struct PairWork {
  const std::vector<ProjectNode>& nodes;
  const std::vector<ProjectScan>& scans;
  const Store& store;
  const RegisterOptions& options;
  const PairStarts& starts;  ///< of pairs that have one
  JobEngine* engine;         ///< null: here
  const std::filesystem::path& folder;
};

/// Registers the pairs whose result is not kept, several at a time; returns all results in the given order.
std::vector<TriedPair> try_pairs(const std::vector<std::pair<std::size_t, std::size_t>>& pairs,
                                 const PairWork& work, PairSearch search, ProjectStatus& status,
                                 Monitor& monitor);

}  // namespace limen
