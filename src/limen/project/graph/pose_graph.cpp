// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/pose_graph.h"

#include "limen/base/named.h"

namespace limen {

const char* to_string(LinkState state) {
  static constexpr Named<LinkState> names[] = {
      {LinkState::verified, "verified"}, {LinkState::bridge, "bridge"}, {LinkState::ambiguous, "ambiguous"},
      {LinkState::rejected, "rejected"}, {LinkState::weak, "weak"},     {LinkState::in_place, "in_place"}};
  return name_of(names, state);
}

const char* to_string(NodeState state) {
  static constexpr Named<NodeState> names[] = {{NodeState::registered, "registered"},
                                               {NodeState::probable, "probable"},
                                               {NodeState::ambiguous, "ambiguous"},
                                               {NodeState::under_constrained, "under_constrained"},
                                               {NodeState::floating, "floating"}};
  return name_of(names, state);
}

}  // namespace limen
