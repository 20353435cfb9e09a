// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/viewpoints.h"

#include <numeric>
#include <optional>

namespace limen {

Viewpoints::Viewpoints(int nodes)
    : first_(static_cast<std::size_t>(nodes)), count_(static_cast<std::size_t>(nodes), 1.0) {
  std::iota(first_.begin(), first_.end(), 0);
}

Viewpoints::Viewpoints(const PoseGraph& graph, const Configuration& configuration) : Viewpoints(graph.nodes) {
  std::vector<std::optional<Vector3d>> at(first_.size());
  for (std::size_t n = 0; n < graph.scanners.size(); ++n) {
    if (graph.scanners[n]) at[n] = configuration.frame_from_node[n] * *graph.scanners[n];
  }
  for (std::size_t n = 0; n < at.size(); ++n) {
    for (std::size_t k = 0; k < n && at[n]; ++k) {
      const bool near = at[k] && first_[k] == static_cast<int>(k) &&
                        configuration.component[k] == configuration.component[n] &&
                        (*at[k] - *at[n]).norm() < kNoOtherPlaceM;
      if (!near) continue;
      first_[n] = static_cast<int>(k);
      count_[k] += 1.0;
      break;
    }
  }
}

}  // namespace limen
