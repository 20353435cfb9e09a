// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "limen/project/solve/project_graph.h"

namespace limen {

/// The graph with the poses of its links as bent passes have them: a link measures where a pass stood when it
/// saw what both see, which drift has moved against the pass as a whole. How passes are bent is found from
/// what `solved` accepted; what that leaves open is added to the covariances. Empty where nothing bends, or
/// no link misses by what a drift may be.
std::optional<PoseGraph> straightened(const std::vector<ProjectNode>& nodes,
                                      const std::vector<TriedPair>& pairs, const ProjectGraph& made,
                                      const SolvedGraph& solved);

}  // namespace limen
