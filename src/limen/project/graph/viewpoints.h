// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "limen/project/graph/configuration.h"

namespace limen {

/// Which scans were taken from one place. A second view from there shows nothing that the first does not, and
/// that both agree says nothing of the building.
class Viewpoints {
 public:
  /// Every scan has its own.
  explicit Viewpoints(int nodes);
  /// By where scanners were in the frames of their components, where that is known: those nearer to each
  /// other than kNoOtherPlaceM. `component`: of each node.
  Viewpoints(const std::vector<std::optional<Vector3d>>& scanners, const std::vector<int>& component);
  /// By PoseGraph::scanners.
  Viewpoints(const PoseGraph& graph, const Configuration& configuration);

  [[nodiscard]] bool is_same(int a, int b) const {
    return first_[static_cast<std::size_t>(a)] == first_[static_cast<std::size_t>(b)];
  }
  /// The places of two scans; the same for all scans from these two.
  [[nodiscard]] std::pair<int, int> of(int a, int b) const {
    return std::minmax(first_[static_cast<std::size_t>(a)], first_[static_cast<std::size_t>(b)]);
  }
  /// Of each of some scans one, divided by how many of them are from its place; 0 of the others.
  [[nodiscard]] std::vector<double> weights(const std::vector<bool>& some) const;

 private:
  std::vector<int> first_;  ///< of each node the first one of its place
};

}  // namespace limen
