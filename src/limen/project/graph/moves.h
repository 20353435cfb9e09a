// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/project/graph/configuration.h"
#include "limen/project/graph/shared_views.h"

namespace limen {

/// A side of the building moved to a place that a pose of a link proposes.
struct Move {
  std::vector<bool> side;
  Rigid3 frame_from_frame;
  double present_nats = 0.0;  ///< what pairs across the cut say of the present place ...
  double moved_nats = 0.0;    ///< ... and of the other
  /// Links that agree with the present place, and not by the same pose with the other.
  std::vector<int> present;
  /// Links that agree with the other place, and not by the same pose with the present.
  std::vector<int> moved;
  std::vector<int> either;              ///< links that agree with both, by one pose or by two
  std::vector<PlacedPair> moved_alone;  ///< of links that agree with the other place alone
  double either_nats = 0.0;             ///< by how much more likely those that agree with both have it there

  [[nodiscard]] double gain() const { return moved_nats - present_nats; }
};

/// How far a move goes: no place repeats nearer than a wall is thick.
enum class MoveTo { other_places, this_place };

/// Every move that a pose of a link proposes which the configuration does not agree with.
std::vector<Move> proposed_moves(const PoseGraph& graph, const LinkMatcher& matcher,
                                 const Configuration& configuration, MoveTo to = MoveTo::other_places);

}  // namespace limen
