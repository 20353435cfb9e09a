// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "limen/project/decide/decisions.h"
#include "limen/project/result/project_result.h"
#include "limen/project/state/project_node.h"

namespace limen {

/// A user's word on a pair.
struct PairWord {
  DecisionKind kind = DecisionKind::accept;
  int pose = 0;  ///< the pair's pose that is meant, its best is 0
};

/// What is believed of the poses of pairs beforehand, by source > target.
using PairStarts = std::map<std::pair<std::size_t, std::size_t>, StartPrior>;

/// Decisions by nodes.
struct UserWords {
  std::vector<Decision> decisions;
  std::vector<std::vector<int>> nodes;  ///< of each decision; empty: a scan is not part of the project
  std::map<std::pair<std::size_t, std::size_t>, PairWord> pairs;  ///< by source > target
  std::set<std::pair<std::size_t, std::size_t>> floors;           ///< pairs whose floors are of one height
  PairStarts starts;                                              ///< where points of a pair were shown
};
UserWords words_by_nodes(const std::vector<Decision>& decisions, const std::vector<ProjectNode>& nodes,
                         const std::vector<ProjectScan>& scans);

/// What the user said in earlier runs, and in `file` (empty: nothing), kept in the project's folder for the
/// next run. `full_name`: how the project calls a scan that a decision names. Throws Error where a file of
/// decisions is no good.
std::vector<Decision> kept_decisions(const std::filesystem::path& folder, const std::string& file,
                                     const std::function<std::string(const std::string&)>& full_name = {});

}  // namespace limen
