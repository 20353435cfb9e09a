// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/project/graph/pose_adjustment.h"

namespace limen {

/// Marks every edge that is part of no cycle (Tarjan 1974). An edge from a node to itself counts for nothing.
std::vector<bool> bridges_of(int nodes, const std::vector<PoseEdge>& edges);

}  // namespace limen
