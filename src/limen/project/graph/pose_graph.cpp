// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/pose_graph.h"

#include <algorithm>
#include <cmath>

namespace limen {

double nats_for(const GraphLink& link, std::size_t pose, double most_nats, double least_wrong) {
  constexpr double kLeast = 1e-9;
  const double wrong =
      std::clamp(link.chance + link.twin, std::max(least_wrong, std::exp(-most_nats)), 1.0 - kLeast);
  const bool best = pose == 0 && link.trust <= LinkTrust::likely;
  const double right = best ? 1.0 - wrong : link.poses[pose].probability;
  return std::clamp(std::log(std::max(right, kLeast) / wrong), 0.0, most_nats);
}

const char* to_string(LinkState state) {
  switch (state) {
    case LinkState::verified:
      return "verified";
    case LinkState::bridge:
      return "bridge";
    case LinkState::ambiguous:
      return "ambiguous";
    case LinkState::rejected:
      return "rejected";
    case LinkState::weak:
      break;
  }
  return "weak";
}

const char* to_string(NodeState state) {
  switch (state) {
    case NodeState::registered:
      return "registered";
    case NodeState::probable:
      return "probable";
    case NodeState::ambiguous:
      return "ambiguous";
    case NodeState::under_constrained:
      return "under_constrained";
    case NodeState::floating:
      break;
  }
  return "floating";
}

}  // namespace limen
