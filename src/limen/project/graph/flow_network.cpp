// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/flow_network.h"

#include <algorithm>
#include <limits>

namespace limen {

void FlowNetwork::connect(int a, int b, int forward, int backward) {
  std::vector<Pipe>& out = pipes_[static_cast<std::size_t>(a)];
  std::vector<Pipe>& in = pipes_[static_cast<std::size_t>(b)];
  out.push_back({b, forward, in.size()});
  in.push_back({a, backward, out.size() - 1});
}

std::optional<std::vector<bool>> FlowNetwork::smallest_cut(const std::vector<int>& start,
                                                           const std::vector<bool>& end, int enough) {
  std::optional<std::vector<bool>> side;
  for (int flow = 0; flow < enough;) {
    const int found = reach(start, end);
    if (found < 0) {
      side.emplace(pipes_.size(), false);
      for (const int node : reached_) (*side)[static_cast<std::size_t>(node)] = true;
      break;
    }
    flow += fill(found);
  }
  empty();
  return side;
}

int FlowNetwork::fill(int end) {
  const auto before = [&](int node) { return before_[static_cast<std::size_t>(node)]; };
  int room = std::numeric_limits<int>::max();
  for (int node = end; before(node).node >= 0; node = before(node).node)
    room = std::min(room, pipes_[static_cast<std::size_t>(before(node).node)][before(node).pipe].room);
  for (int node = end; before(node).node >= 0; node = before(node).node) {
    move(before(node).node, before(node).pipe, room);
    filled_.push_back({before(node).node, before(node).pipe, room});
  }
  return room;
}

void FlowNetwork::move(int node, std::size_t pipe, int flow) {
  Pipe& along = pipes_[static_cast<std::size_t>(node)][pipe];
  along.room -= flow;
  pipes_[static_cast<std::size_t>(along.to)][along.back].room += flow;
}

void FlowNetwork::empty() {
  for (const Filled& filled : filled_) move(filled.node, filled.pipe, -filled.flow);
  filled_.clear();
}

int FlowNetwork::reach(const std::vector<int>& start, const std::vector<bool>& end) {
  ++search_;
  reached_ = start;
  for (const int node : start) {
    seen_[static_cast<std::size_t>(node)] = search_;
    before_[static_cast<std::size_t>(node)] = {};
  }
  for (std::size_t next = 0; next < reached_.size(); ++next) {
    const int node = reached_[next];
    const std::vector<Pipe>& out = pipes_[static_cast<std::size_t>(node)];
    for (std::size_t k = 0; k < out.size(); ++k) {
      const auto to = static_cast<std::size_t>(out[k].to);
      if (out[k].room <= 0 || seen_[to] == search_) continue;
      seen_[to] = search_;
      before_[to] = {node, k};
      if (end[to]) return out[k].to;
      reached_.push_back(out[k].to);
    }
  }
  return -1;
}

}  // namespace limen
