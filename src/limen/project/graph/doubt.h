// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/project/graph/pose_graph.h"
#include "limen/project/graph/shared_views.h"

namespace limen {

/// Why a node may stand elsewhere, as probabilities.
struct NodeDoubt {
  double twin = 1.0;        ///< its side of the building is laid on another place built alike
  double chance = 1.0;      ///< the links that hold it are wrong in other ways
  std::vector<int> links;   ///< the links that hold it, where they are fewest or least sure
  double held_nats = 0.0;   ///< what links say for its side, whatever speaks against it
  std::vector<int> across;  ///< all links that would lie on twins

  [[nodiscard]] double total() const { return twin + chance - twin * chance; }
  /// The same where the odds that a side of the project stands apart from the rest are these, 1 before.
  [[nodiscard]] NodeDoubt where_few_stand_apart(double odds) const {
    NodeDoubt less = *this;
    less.twin = twin * odds / (1.0 - twin + twin * odds);
    return less;
  }
};

struct DoubtOptions {
  /// Links that leave a direction free hold a node's place as well, but for that direction.
  bool weak_links_hold = false;
};

/// How probable it is that each node stands wrongly against its component's `reference` (of each node: the
/// node that lends its component the frame, -1: none).
///
/// Twins: places built alike come in rows and storeys, so that a whole side of the building may be laid on
/// its twin, and all links across lie on twins together. That there is such a twin is believed once, and of
/// one furnished alike once; what things say against it multiplies over the links across, as far as they see
/// different ones. The cut between the node and the reference counts across which least is said; pairs that
/// speak for a twin (`PoseGraph::against`) speak against their side.
/// Chance: links that see different surface err independently, and that wrong poses close a loop is rare in
/// itself; the smallest cut between the node and the reference counts, links that see the same only once.
std::vector<NodeDoubt> doubts_of(const PoseGraph& graph, const AcceptedPoses& accepted,
                                 const std::vector<int>& reference, const DoubtOptions& options = {});

/// The same of a whole side against the rest of its component: how probable it is that the two stand wrongly
/// against one another, by what the links across say.
NodeDoubt doubt_of_side(const PoseGraph& graph, const AcceptedPoses& accepted, const std::vector<bool>& side);

}  // namespace limen
