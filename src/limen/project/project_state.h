// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "limen/project/project.h"
#include "limen/project/store/store.h"

namespace limen {

/// One scan or model of a run, with its digest.
struct ProjectNode {
  std::size_t scan = 0;  ///< index into ProjectResult::scans
  std::size_t file = 0;  ///< number of its file
  std::string key;       ///< of its features
  ScanDigest digest;
  bool grouped = false;  ///< its file holds several scans that are known to one another
};

/// A pair that was tried, with what came of it; nodes by number, source > target.
struct TriedPair {
  std::size_t source = 0;
  std::size_t target = 0;
  RegistrationResult result;
};

/// Writes how far the project is to the store, for `project status`.
void write_status(const std::filesystem::path& folder, const ProjectStatus& status);

/// Registers the pairs whose result is not kept, several at a time; returns all results in the given order.
std::vector<TriedPair> try_pairs(const std::vector<std::pair<std::size_t, std::size_t>>& pairs,
                                 const std::vector<ProjectNode>& nodes, const Store& store,
                                 const RegisterOptions& options, const std::filesystem::path& folder,
                                 ProjectStatus& status, Monitor& monitor);

/// The frame, the states and the words: everything of `result` but its scans' files.
void assemble(const std::vector<ProjectNode>& nodes, const std::vector<TriedPair>& pairs,
              ProjectResult& result);

}  // namespace limen
