// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/doubt.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "limen/base/progress.h"
#include "limen/project/graph/flow_network.h"

namespace limen {
namespace {

constexpr double kMostNats = 14.0;     // no link is surer than about one in a million
constexpr double kLoopNats = 7.0;      // a wrong pose that agrees with another link, once in a thousand ...
constexpr double kOpenLoopNats = 3.0;  // ... or one of several, which repeat what repeats in the building
constexpr double kEnoughNats = 30.0;
constexpr double kUnits = 1000.0;  // of the flow, per nat

class DoubtSearch {
 public:
  DoubtSearch(const PoseGraph& graph, const AcceptedPoses& accepted)
      : graph_(graph), accepted_(accepted), views_(graph, accepted) {
    for (std::size_t k = 0; k < graph.links.size(); ++k) {
      if (accepted.pose[k] >= 0 && graph.links[k].trust != LinkTrust::weak)
        held_.push_back(static_cast<int>(k));
    }
    std::stable_sort(held_.begin(), held_.end(), [&](int a, int b) { return link(a).twin < link(b).twin; });
    for (const int k : held_) share_.push_back((nats(k) + loop_nats(k)) / views_.witnesses_like(k));
  }

  std::vector<NodeDoubt> run(const std::vector<int>& reference) {
    std::vector<NodeDoubt> doubts(static_cast<std::size_t>(graph_.nodes));
    for (int root = 0; root < graph_.nodes; ++root) {
      if (reference[static_cast<std::size_t>(root)] == root) add_twins(root, doubts);
    }
    for (int node = 0; node < graph_.nodes; ++node) {
      CancelScope::check();
      const int root = reference[static_cast<std::size_t>(node)];
      NodeDoubt& doubt = doubts[static_cast<std::size_t>(node)];
      if (root == node) doubt = {0.0, 0.0, {}};
      if (root >= 0 && root != node) add_chance(node, root, doubt);
    }
    return doubts;
  }

 private:
  [[nodiscard]] const GraphLink& link(int k) const { return graph_.links[static_cast<std::size_t>(k)]; }
  [[nodiscard]] double loop_nats(int k) const {
    return link(k).trust == LinkTrust::open ? kOpenLoopNats : kLoopNats;
  }
  /// Of the pose that was taken.
  [[nodiscard]] double nats(int k) const {
    const auto taken = static_cast<std::size_t>(accepted_.pose[static_cast<std::size_t>(k)]);
    const double other = link(k).trust == LinkTrust::open ? 1.0 - link(k).poses[taken].probability : 0.0;
    const double chance = std::max(link(k).chance, other);
    return chance > 0.0 ? std::clamp(-std::log(chance), 0.0, kMostNats) : kMostNats;
  }

  /// The surest way to each node: along the tree that surer links make first (Kruskal 1956), which held_ is
  /// sorted for.
  void add_twins(int root, std::vector<NodeDoubt>& doubts) {
    std::vector<bool> reached(static_cast<std::size_t>(graph_.nodes), false);
    reached[static_cast<std::size_t>(root)] = true;
    doubts[static_cast<std::size_t>(root)].twin = 0.0;
    // Prim's order: the surest link that leads on is taken first; ties by number.
    double worst = 0.0;
    for (bool grown = true; grown;) {
      grown = false;
      for (const int k : held_) {
        const auto s = static_cast<std::size_t>(link(k).source);
        const auto t = static_cast<std::size_t>(link(k).target);
        if (reached[s] == reached[t]) continue;
        worst = std::max(worst, link(k).twin);
        NodeDoubt& doubt = doubts[reached[s] ? t : s];
        doubt.twin = worst;
        doubt.links = {k};
        reached[s] = reached[t] = grown = true;
        break;
      }
    }
  }

  void add_chance(int node, int root, NodeDoubt& doubt) const {
    FlowNetwork network(static_cast<std::size_t>(graph_.nodes));
    for (std::size_t i = 0; i < held_.size(); ++i) {
      const auto room = static_cast<int>(std::lround(kUnits * share_[i]));
      network.connect(link(held_[i]).source, link(held_[i]).target, room, room);
    }
    std::vector<bool> start(static_cast<std::size_t>(graph_.nodes), false);
    std::vector<bool> end = start;
    start[static_cast<std::size_t>(node)] = true;
    end[static_cast<std::size_t>(root)] = true;
    const std::optional<std::vector<bool>> side =
        network.smallest_cut(start, end, static_cast<int>(kUnits * (kEnoughNats + kLoopNats)));
    doubt.chance = 0.0;
    if (!side) return;
    std::vector<int> crossing;
    for (const int k : held_) {
      if ((*side)[static_cast<std::size_t>(link(k).source)] !=
          (*side)[static_cast<std::size_t>(link(k).target)])
        crossing.push_back(k);
    }
    std::stable_sort(crossing.begin(), crossing.end(), [&](int a, int b) { return nats(a) > nats(b); });
    const std::vector<int> chosen = views_.independent(crossing, *side);
    double all = 0.0;
    double most = 0.0;  // the first link that holds closes no loop
    for (const int k : chosen) {
      all += nats(k) + loop_nats(k);
      most = std::max(most, loop_nats(k));
    }
    all -= most;
    doubt.chance = std::exp(-std::max(0.0, all));
    if (doubt.chance > doubt.twin) doubt.links = chosen;
  }

  const PoseGraph& graph_;
  const AcceptedPoses& accepted_;
  SharedViews views_;
  std::vector<int> held_;      ///< accepted links that hold, those of the least probable twin first
  std::vector<double> share_;  ///< of each of them: nats, shared with those that see the same
};

}  // namespace

std::vector<NodeDoubt> doubts_of(const PoseGraph& graph, const AcceptedPoses& accepted,
                                 const std::vector<int>& reference) {
  return DoubtSearch(graph, accepted).run(reference);
}

}  // namespace limen
