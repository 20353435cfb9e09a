// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/flow_network.h"

#include <algorithm>
#include <deque>
#include <limits>

namespace limen {

void FlowNetwork::connect(int a, int b, int forward, int backward) {
  std::vector<Pipe>& out = pipes_[static_cast<std::size_t>(a)];
  std::vector<Pipe>& in = pipes_[static_cast<std::size_t>(b)];
  out.push_back({b, forward, in.size()});
  in.push_back({a, backward, out.size() - 1});
}

std::optional<std::vector<bool>> FlowNetwork::smallest_cut(const std::vector<bool>& start,
                                                           const std::vector<bool>& end, int enough) {
  for (int flow = 0; flow < enough;) {
    Search search = reach(start, end);
    if (search.end < 0) return std::move(search.reached);
    flow += fill(search);
  }
  return {};
}

int FlowNetwork::fill(const Search& search) {
  const auto came = [&](int node) { return search.came[static_cast<std::size_t>(node)]; };
  int room = std::numeric_limits<int>::max();
  for (int node = search.end; came(node).first >= 0; node = came(node).first)
    room = std::min(room, pipes_[static_cast<std::size_t>(came(node).first)][came(node).second].room);
  for (int node = search.end; came(node).first >= 0; node = came(node).first) {
    Pipe& pipe = pipes_[static_cast<std::size_t>(came(node).first)][came(node).second];
    pipe.room -= room;
    pipes_[static_cast<std::size_t>(node)][pipe.back].room += room;
  }
  return room;
}

FlowNetwork::Search FlowNetwork::reach(const std::vector<bool>& start, const std::vector<bool>& end) const {
  Search search{start, std::vector<std::pair<int, std::size_t>>(pipes_.size(), {-1, 0}), -1};
  std::deque<int> waiting;
  for (std::size_t node = 0; node < pipes_.size(); ++node) {
    if (start[node]) waiting.push_back(static_cast<int>(node));
  }
  while (!waiting.empty()) {
    const int node = waiting.front();
    waiting.pop_front();
    const std::vector<Pipe>& out = pipes_[static_cast<std::size_t>(node)];
    for (std::size_t k = 0; k < out.size(); ++k) {
      const auto to = static_cast<std::size_t>(out[k].to);
      if (out[k].room <= 0 || search.reached[to]) continue;
      search.reached[to] = true;
      search.came[to] = {node, k};
      if (end[to]) {
        search.end = out[k].to;
        return search;
      }
      waiting.push_back(out[k].to);
    }
  }
  return search;
}

}  // namespace limen
