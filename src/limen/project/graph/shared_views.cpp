// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/shared_views.h"

#include <algorithm>

namespace limen {
namespace {

constexpr double kSameView = 0.6;  // share of a link's surface that two scans share: they are one witness

/// The ends of what crosses a cut, that on the moved side first.
std::pair<int, int> ends_across(const GraphLink& pair, const std::vector<bool>& moved) {
  return moved[static_cast<std::size_t>(pair.source)] ? std::pair(pair.source, pair.target)
                                                      : std::pair(pair.target, pair.source);
}

}  // namespace

bool is_laid_so(const GraphLink& pair, const AcceptedPoses& accepted) {
  constexpr double kNearM = 0.3;
  const auto s = static_cast<std::size_t>(pair.source);
  const auto t = static_cast<std::size_t>(pair.target);
  if (accepted.component[s] < 0 || accepted.component[s] != accepted.component[t]) return false;
  const Rigid3 laid = inverse(accepted.frame_from_node[t]) * accepted.frame_from_node[s];
  const LinkPose& pose = pair.poses.front();
  const Vector3d at = inverse(pose.target_from_source) * pose.centre;
  return (laid * at - pose.centre).norm() < kNearM;
}

SharedViews::SharedViews(const PoseGraph& graph, const AcceptedPoses& accepted)
    : graph_(graph),
      neighbours_(static_cast<std::size_t>(graph.nodes)),
      with_first_(static_cast<std::size_t>(graph.nodes), 0.0),
      with_second_(with_first_) {
  for (std::size_t k = 0; k < graph.links.size(); ++k) {
    if (accepted.pose[k] < 0) continue;
    const GraphLink& link = graph.links[k];
    const LinkPose& pose = link.poses[static_cast<std::size_t>(accepted.pose[k])];
    neighbours_[static_cast<std::size_t>(link.source)].push_back({link.target, pose.agreeing_m2});
    neighbours_[static_cast<std::size_t>(link.target)].push_back({link.source, pose.agreeing_m2});
  }
  for (std::vector<Neighbour>& all : neighbours_) std::stable_sort(all.begin(), all.end(), by_node);
}

bool SharedViews::by_node(const Neighbour& a, const Neighbour& b) {
  return a.node < b.node;
}

const SharedViews::Neighbour* SharedViews::neighbour(int a, int b) const {
  const std::vector<Neighbour>& all = neighbours_[static_cast<std::size_t>(a)];
  const auto found = std::lower_bound(all.begin(), all.end(), Neighbour{b, 0.0}, by_node);
  return found == all.end() || found->node != b ? nullptr : &*found;
}

double SharedViews::shared(int a, int b) const {
  const Neighbour* found = neighbour(a, b);
  return found == nullptr ? 0.0 : found->shared_m2;
}

bool SharedViews::same_view(int a, int b, double surface_m2) const {
  return a == b || shared(a, b) > kSameView * surface_m2;
}

double SharedViews::seen_already(const GraphLink& pair, const std::vector<const GraphLink*>& others,
                                 const std::vector<bool>& moved) const {
  const std::pair<int, int> own = ends_across(pair, moved);
  const double surface = pair.poses.front().agreeing_m2;
  if (others.empty()) return 0.0;
  if (surface <= 0.0) return 1.0;
  const auto mark = [&](int node, std::vector<double>& share, bool on) {
    share[static_cast<std::size_t>(node)] = on ? 1.0 : 0.0;
    for (const Neighbour& other : neighbours_[static_cast<std::size_t>(node)])
      share[static_cast<std::size_t>(other.node)] = on ? std::min(1.0, other.shared_m2 / surface) : 0.0;
  };
  mark(own.first, with_first_, true);
  mark(own.second, with_second_, true);
  double most = 0.0;
  for (const GraphLink* other : others) {
    const std::pair<int, int> theirs = ends_across(*other, moved);
    most = std::max(most, with_first_[static_cast<std::size_t>(theirs.first)] *
                              with_second_[static_cast<std::size_t>(theirs.second)]);
  }
  mark(own.first, with_first_, false);
  mark(own.second, with_second_, false);
  return most;
}

std::vector<double> SharedViews::fresh_shares(const std::vector<SaidByPair>& said,
                                              const std::vector<bool>& moved) const {
  std::vector<double> fresh;
  fresh.reserve(said.size());
  std::vector<const GraphLink*> heard_for;
  std::vector<const GraphLink*> heard_against;
  for (const SaidByPair& one : said) {
    std::vector<const GraphLink*>& heard = one.nats > 0.0 ? heard_for : heard_against;
    fresh.push_back(1.0 - seen_already(*one.pair, heard, moved));
    heard.push_back(one.pair);
  }
  return fresh;
}

std::vector<int> SharedViews::independent(const std::vector<int>& links,
                                          const std::vector<bool>& moved) const {
  std::vector<int> chosen;
  for (const int k : links) {
    const std::pair<int, int> own = ends_across(graph_.links[static_cast<std::size_t>(k)], moved);
    const double surface = graph_.links[static_cast<std::size_t>(k)].poses.front().agreeing_m2;
    const bool counted = std::any_of(chosen.begin(), chosen.end(), [&](int other) {
      const std::pair<int, int> theirs = ends_across(graph_.links[static_cast<std::size_t>(other)], moved);
      return same_view(own.first, theirs.first, surface) && same_view(own.second, theirs.second, surface);
    });
    if (!counted) chosen.push_back(k);
  }
  return chosen;
}

std::vector<int> SharedViews::like(int node, double surface_m2) const {
  std::vector<int> nodes = {node};
  for (const Neighbour& other : neighbours_[static_cast<std::size_t>(node)]) {
    if (other.shared_m2 > kSameView * surface_m2) nodes.push_back(other.node);
  }
  return nodes;
}

int SharedViews::witnesses_like(int k) const {
  const GraphLink& link = graph_.links[static_cast<std::size_t>(k)];
  const double surface = link.poses.front().agreeing_m2;
  int count = 0;
  const std::vector<int> others = like(link.target, surface);
  for (const int a : like(link.source, surface)) {
    for (const int b : others) count += neighbour(a, b) != nullptr ? 1 : 0;
  }
  return std::max(1, count);
}

}  // namespace limen
