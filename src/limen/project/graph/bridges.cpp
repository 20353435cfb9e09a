// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/bridges.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace limen {

std::vector<bool> bridges_of(int nodes, const std::vector<PoseEdge>& edges) {
  std::vector<std::vector<std::pair<int, std::size_t>>> arms(static_cast<std::size_t>(nodes));
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (edges[e].source == edges[e].target) continue;
    arms[static_cast<std::size_t>(edges[e].source)].emplace_back(edges[e].target, e);
    arms[static_cast<std::size_t>(edges[e].target)].emplace_back(edges[e].source, e);
  }
  std::vector<bool> bridge(edges.size(), false);
  std::vector<int> order(arms.size(), -1);
  std::vector<int> low(arms.size(), 0);
  struct Visit {
    std::size_t node;
    std::size_t by;
    std::size_t next;
  };
  int count = 0;
  for (std::size_t root = 0; root < arms.size(); ++root) {
    if (order[root] >= 0) continue;
    std::vector<Visit> stack{{root, edges.size(), 0}};
    order[root] = low[root] = count++;
    while (!stack.empty()) {
      Visit& top = stack.back();
      if (top.next < arms[top.node].size()) {
        const auto [to, edge] = arms[top.node][top.next++];
        const auto other = static_cast<std::size_t>(to);
        if (edge == top.by) continue;
        if (order[other] >= 0) {
          low[top.node] = std::min(low[top.node], order[other]);
        } else {
          order[other] = low[other] = count++;
          stack.push_back({other, edge, 0});
        }
        continue;
      }
      const Visit done = top;
      stack.pop_back();
      if (stack.empty()) continue;
      Visit& parent = stack.back();
      low[parent.node] = std::min(low[parent.node], low[done.node]);
      if (low[done.node] > order[parent.node]) bridge[done.by] = true;
    }
  }
  return bridge;
}

}  // namespace limen
