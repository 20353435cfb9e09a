// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/viewpoints.h"

#include <numeric>
#include <optional>

namespace limen {

Viewpoints::Viewpoints(int nodes) : first_(static_cast<std::size_t>(nodes)) {
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
      break;
    }
  }
}

std::vector<double> Viewpoints::weights(const std::vector<bool>& some) const {
  std::vector<double> count(first_.size(), 0.0);
  for (std::size_t n = 0; n < some.size(); ++n)
    count[static_cast<std::size_t>(first_[n])] += some[n] ? 1.0 : 0.0;
  std::vector<double> weights(first_.size(), 0.0);
  for (std::size_t n = 0; n < some.size(); ++n)
    if (some[n]) weights[n] = 1.0 / count[static_cast<std::size_t>(first_[n])];
  return weights;
}

}  // namespace limen
