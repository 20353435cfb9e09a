// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/project/graph/pose_graph.h"

namespace limen {

/// Loops of three links, and of four where a link is in none of three, tested with the given poses; links
/// with pose -1 are tested with their best. At most `most` per link.
std::vector<GraphLoop> tested_loops(const PoseGraph& graph, const std::vector<int>& poses, std::size_t most);

}  // namespace limen
