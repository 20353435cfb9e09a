// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "limen/project/graph/configuration.h"
#include "limen/project/graph/flow_network.h"

namespace limen {

/// The weakest cuts through what pairs say that agree with a configuration, in nats.
class WeakestCut {
 public:
  explicit WeakestCut(int nodes)
      : network_(static_cast<std::size_t>(nodes)), held_(static_cast<std::size_t>(nodes), false) {}

  void connect(int a, int b, double nats) { connect(a, b, nats, nats); }
  /// `nats`: if only a is on the side; `back`: if only b is.
  void connect(int a, int b, double nats, double back) {
    const int there = room_for(nats);
    const int and_back = room_for(back);
    if (there > 0 || and_back > 0) network_.connect(a, b, there, and_back);
  }

  /// The nodes on the side of `from` of the weakest cut between it and `to`; empty: enough joins them.
  [[nodiscard]] std::vector<bool> side(int from, int to) {
    std::vector<bool> end(held_.size(), false);
    end[static_cast<std::size_t>(to)] = true;
    return network_.smallest_cut({from}, end, kEnough).value_or(std::vector<bool>{});
  }

  void hold(int node) { held_[static_cast<std::size_t>(node)] = true; }

  /// The same between a node and all that are held. A node that enough joins to them is held from then on.
  [[nodiscard]] std::vector<bool> side_of(int node) {
    if (held_[static_cast<std::size_t>(node)]) return {};
    std::optional<std::vector<bool>> side = network_.smallest_cut({node}, held_, kEnough);
    if (!side) hold(node);
    return side ? std::move(*side) : std::vector<bool>{};
  }

 private:
  static constexpr double kUnits = 1000.0;  // of the flow, per nat
  static constexpr int kEnough = 40000;     // 40 nats: more never makes a doubt

  static int room_for(double nats) { return static_cast<int>(std::lround(kUnits * std::max(0.0, nats))); }

  FlowNetwork network_;
  std::vector<bool> held_;
};

}  // namespace limen
