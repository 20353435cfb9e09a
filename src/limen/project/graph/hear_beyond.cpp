// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/hear_beyond.h"

#include <algorithm>

#include "limen/base/parallel.h"

namespace limen {
namespace {

constexpr double kNatsPerM2 = 0.7;
constexpr double kMostBeyond = 3.0;

/// The nodes that these links hold a node to; none where one of them holds another node.
std::vector<int> held_to(const PoseGraph& graph, int node, const std::vector<int>& links) {
  std::vector<int> others;
  for (const int k : links) {
    const GraphLink& link = graph.links[static_cast<std::size_t>(k)];
    if (link.source != node && link.target != node) return {};
    others.push_back(link.source == node ? link.target : link.source);
  }
  return others;
}

}  // namespace

std::vector<double> hear_beyond(const PoseGraph& graph, const AcceptedPoses& accepted,
                                const std::vector<NodeDoubt>& doubts, const std::vector<bool>& firm,
                                double risk, const PoseHearing& hearing) {
  std::vector<double> nats(doubts.size(), 0.0);
  if (!hearing.beyond) return nats;
  const auto pose_in = [&](int node, int other) {
    return NodePose{other, inverse(accepted.frame_from_node[static_cast<std::size_t>(other)]) *
                               accepted.frame_from_node[static_cast<std::size_t>(node)]};
  };
  parallel_for(doubts.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      const NodeDoubt& doubt = doubts[n];
      if (accepted.component[n] < 0 || firm[n] || doubt.chance <= std::max(risk, doubt.twin)) continue;
      const int node = static_cast<int>(n);
      const std::vector<int> ends = held_to(graph, node, doubt.links);
      if (ends.empty()) continue;
      std::vector<NodePose> held;
      std::vector<NodePose> others;
      for (const int other : ends) held.push_back(pose_in(node, other));
      for (int other = 0; other < graph.nodes; ++other) {
        const auto o = static_cast<std::size_t>(other);
        if (firm[o] && accepted.component[o] == accepted.component[n]) others.push_back(pose_in(node, other));
      }
      nats[n] = std::clamp(kNatsPerM2 * hearing.beyond(node, held, others), 0.0, kMostBeyond);
    }
  });
  return nats;
}

}  // namespace limen
