// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/viewpoints.h"

#include <numeric>

namespace limen {

Viewpoints::Viewpoints(int nodes) : first_(static_cast<std::size_t>(nodes)) {
  std::iota(first_.begin(), first_.end(), 0);
}

Viewpoints::Viewpoints(const std::vector<std::optional<Vector3d>>& scanners,
                       const std::vector<int>& component)
    : Viewpoints(static_cast<int>(scanners.size())) {
  for (std::size_t n = 0; n < scanners.size(); ++n) {
    for (std::size_t k = 0; k < n && scanners[n]; ++k) {
      const bool near = scanners[k] && first_[k] == static_cast<int>(k) && component[k] == component[n] &&
                        (*scanners[k] - *scanners[n]).norm() < kNoOtherPlaceM;
      if (!near) continue;
      first_[n] = static_cast<int>(k);
      break;
    }
  }
}

Viewpoints::Viewpoints(const PoseGraph& graph, const Configuration& configuration)
    : Viewpoints(
          [&] {
            std::vector<std::optional<Vector3d>> placed(static_cast<std::size_t>(graph.nodes));
            for (std::size_t n = 0; n < graph.scanners.size(); ++n)
              if (graph.scanners[n]) placed[n] = configuration.frame_from_node[n] * *graph.scanners[n];
            return placed;
          }(),
          configuration.component) {}

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
