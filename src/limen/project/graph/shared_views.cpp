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

SharedViews::SharedViews(const PoseGraph& graph, const AcceptedPoses& accepted)
    : graph_(graph), neighbours_(static_cast<std::size_t>(graph.nodes)) {
  for (std::size_t k = 0; k < graph.links.size(); ++k) {
    if (accepted.pose[k] < 0) continue;
    const GraphLink& link = graph.links[k];
    const LinkPose& pose = link.poses[static_cast<std::size_t>(accepted.pose[k])];
    shared_[std::minmax(link.source, link.target)] = pose.agreeing_m2;
    neighbours_[static_cast<std::size_t>(link.source)].push_back(link.target);
    neighbours_[static_cast<std::size_t>(link.target)].push_back(link.source);
  }
}

double SharedViews::shared(int a, int b) const {
  const auto found = shared_.find(std::minmax(a, b));
  return found == shared_.end() ? 0.0 : found->second;
}

bool SharedViews::same_view(int a, int b, double surface_m2) const {
  return a == b || shared(a, b) > kSameView * surface_m2;
}

double SharedViews::seen_already(const GraphLink& pair, const std::vector<const GraphLink*>& others,
                                 const std::vector<bool>& moved) const {
  const std::pair<int, int> own = ends_across(pair, moved);
  const double surface = pair.poses.front().agreeing_m2;
  const auto share = [&](int a, int b) {
    return a == b || surface <= 0.0 ? 1.0 : std::min(1.0, shared(a, b) / surface);
  };
  double most = 0.0;
  for (const GraphLink* other : others) {
    const std::pair<int, int> theirs = ends_across(*other, moved);
    most = std::max(most, share(own.first, theirs.first) * share(own.second, theirs.second));
  }
  return most;
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
  for (const int other : neighbours_[static_cast<std::size_t>(node)]) {
    if (same_view(node, other, surface_m2)) nodes.push_back(other);
  }
  return nodes;
}

int SharedViews::witnesses_like(int k) const {
  const GraphLink& link = graph_.links[static_cast<std::size_t>(k)];
  const double surface = link.poses.front().agreeing_m2;
  int count = 0;
  const std::vector<int> others = like(link.target, surface);
  for (const int a : like(link.source, surface)) {
    for (const int b : others) count += shared_.count(std::minmax(a, b)) > 0 ? 1 : 0;
  }
  return std::max(1, count);
}

}  // namespace limen
