// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "limen/project/retrieve/choose_pairs.h"
#include "limen/project/state/project_node.h"
#include "limen/project/state/words.h"

namespace limen {

/// Results of pairs, in their order.
using PairTrier = std::function<std::vector<TriedPair>(const PairList&)>;

/// First the pairs whose planes promise most; then, where they led to poses, those that should see the most
/// of one another; for scans that are not held yet the next in their list. No more than `pairs_per_scan` on
/// average. By nodes.
std::vector<TriedPair> try_in_waves(const std::vector<ProjectNode>& nodes, const UserWords& words,
                                    double risk, int pairs_per_scan, const PairTrier& try_all);

/// The order in which pairs are reported.
bool by_nodes(const TriedPair& a, const TriedPair& b);

}  // namespace limen
