// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "limen/project/graph/pose_graph.h"
#include "limen/project/state/project_node.h"

namespace limen {

/// Static scans without a place whose scanner is about 3.28 times as high above its floor as those of the
/// placed scans: their numbers may be feet.
std::vector<std::size_t> scans_in_feet(const std::vector<ProjectNode>& nodes, const SolvedGraph& solved);

}  // namespace limen
