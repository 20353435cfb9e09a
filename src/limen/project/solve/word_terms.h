// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "limen/project/adjust/plane_adjustment.h"
#include "limen/project/solve/project_graph.h"

namespace limen {

/// The plane of a scan's floor: the level one clearly below the scanner of which it sees most there; -1: none
/// was seen.
int floor_of(const ScanDigest& digest);

/// By how much the floor of `source` lies above that of `target` with a pose between them (about the local
/// origins); empty where one of them shows none.
std::optional<double> floors_apart(const ScanDigest& source, const ScanDigest& target,
                                   const Rigid3& target_from_source);

/// Adds a user's words on level scans and floors of one height to the adjustment, but those that are
/// `broken`. Scans that are asked to be level share what is up (0.02 degrees), which is the survey's where
/// they stand in its frame, else one more unknown for each component. Floors of one height differ by 7 mm,
/// one deviation, along what is up for one of the scans.
void add_word_terms(const UserWords& words, const std::vector<bool>& broken,
                    const std::vector<ProjectNode>& nodes, const SolvedGraph& solved,
                    const std::vector<bool>& controlled, JointProblem& problem);

/// Of each decision: whether a solution that does not heed these words contradicts it (once in a thousand by
/// chance).
std::vector<bool> broken_words(const UserWords& words, const std::vector<ProjectNode>& nodes,
                               const SolvedGraph& solved, const std::vector<bool>& controlled);

/// Why each decision on what is level was of no use; empty of the others.
std::vector<std::string> idle_words(const UserWords& words, const std::vector<ProjectNode>& nodes,
                                    const SolvedGraph& solved, const std::vector<bool>& controlled);

}  // namespace limen
