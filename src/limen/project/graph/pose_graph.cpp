// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/pose_graph.h"

namespace limen {

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
    case LinkState::in_place:
      return "in_place";
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
