// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/state/words.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <thread>

#include "limen/base/atomic_file.h"
#include "limen/base/error.h"
#include "limen/base/folder_lock.h"
#include "limen/project/state/project_status.h"
#include "limen/project/state/scan_names.h"

namespace limen {
namespace {

std::filesystem::path kept_in(const std::filesystem::path& folder) {
  return folder / "decisions.json";
}

std::vector<Decision> said_before(const std::filesystem::path& folder) {
  std::error_code ignored;
  if (!std::filesystem::exists(kept_in(folder), ignored)) return {};
  return read_decisions(kept_in(folder));
}

std::vector<Decision> with_full_names(std::vector<Decision> decisions,
                                      const std::function<std::string(const std::string&)>& full_name) {
  if (!full_name) return decisions;
  for (Decision& decision : decisions) {
    for (std::string& name : decision.scans) name = full_name(name);
    decision = in_order(std::move(decision));
  }
  return decisions;
}

/// Answers given at the same time are written one after another.
std::unique_ptr<FolderLock> lock_of_decisions(const std::filesystem::path& folder) {
  constexpr int kTries = 200;
  const std::string taken = "another limen is saving decisions in this folder";
  for (int k = 1;; ++k) {
    try {
      return std::make_unique<FolderLock>(folder, taken, "try again", ".limen-decisions-lock");
    } catch (const Error& error) {
      if (error.problem() != taken || k == kTries) throw;
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
  }
}

/// `turned`: the first scan is the target.
StartPrior start_of(const Decision& decision, bool turned) {
  StartPrior start = start_from_points(decision.points);
  if (turned) start.target_from_source = inverse(start.target_from_source);
  return start;
}

}  // namespace

UserWords words_by_nodes(const std::vector<Decision>& decisions, const std::vector<ProjectNode>& nodes,
                         const std::vector<ProjectScan>& scans) {
  UserWords words;
  words.decisions = decisions;
  for (const Decision& decision : decisions) {
    std::vector<int> meant;
    for (const std::string& scan : decision.scans) {
      const int node = node_called(scan, nodes, scans);
      if (node >= 0) meant.push_back(node);
    }
    if (meant.size() != decision.scans.size() || (meant.size() == 2 && meant[0] == meant[1])) meant.clear();
    words.nodes.push_back(meant);
    if (meant.size() != 2) continue;
    const auto source = static_cast<std::size_t>(std::max(meant[0], meant[1]));
    const auto target = static_cast<std::size_t>(std::min(meant[0], meant[1]));
    if (decision.kind == DecisionKind::same_floor)
      words.floors.emplace(source, target);
    else if (decision.kind == DecisionKind::start)
      words.starts[{source, target}] = start_of(decision, meant[0] < meant[1]);
    else
      words.pairs[{source, target}] = {decision.kind, decision.pose};
  }
  return words;
}

std::vector<Decision> kept_decisions(const std::filesystem::path& folder, const std::string& file,
                                     const std::function<std::string(const std::string&)>& full_name) {
  std::vector<Decision> decisions = with_full_names(said_before(folder), full_name);
  if (file.empty()) return decisions;
  decisions = merged(std::move(decisions), with_full_names(read_decisions(file), full_name));
  write_file(kept_in(folder), decisions_text(decisions));
  return decisions;
}

std::vector<Decision> decide(const std::filesystem::path& folder, const Decision& decision,
                             const std::function<std::string(const std::string&)>& full_name) {
  static_cast<void>(project_status(folder));  // only a project's folder is written to
  const auto lock = lock_of_decisions(folder);
  std::vector<Decision> decisions = merged(with_full_names(said_before(folder), full_name), {decision});
  write_file(kept_in(folder), decisions_text(decisions));
  return decisions;
}

}  // namespace limen
