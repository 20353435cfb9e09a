// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/refuted_places.h"

#include <algorithm>

namespace limen {
namespace {

// As of two poses of one pair: what stands in seen free space weighs four times what agrees (1.9 nats per
// m^2), but of a place that is right some may, for doors and furniture move.
constexpr double kAgainstNatsPerM2 = 7.6;
constexpr double kMovedM2 = 1.0;
constexpr double kMovedShare = 0.25;  // of what agrees, in rooms that were used in between

}  // namespace

double nats_of_contradiction(const PoseHeard& heard) {
  return kAgainstNatsPerM2 *
         std::max(0.0, heard.contradicted_m2 - kMovedM2 - kMovedShare * heard.agreeing_m2);
}

double nats_against_place(const AcceptedPoses& accepted, int node, const Rigid3& frame_from_frame,
                          const std::vector<bool>& firm, const PoseHearing& hearing) {
  const auto own = static_cast<std::size_t>(node);
  const Rigid3& present = accepted.frame_from_node[own];
  const Rigid3 moved = frame_from_frame * present;
  double against_other = 0.0;
  double against_present = 0.0;
  for (std::size_t k = 0; k < firm.size(); ++k) {
    if (!firm[k] || k == own || accepted.component[k] != accepted.component[own]) continue;
    const Rigid3 node_from_frame = inverse(accepted.frame_from_node[k]);
    const auto said = [&](const Rigid3& place) {
      return nats_of_contradiction(hearing.surface(node, static_cast<int>(k), node_from_frame * place));
    };
    against_other = std::max(against_other, said(moved));
    against_present += said(present);
  }
  return against_other - against_present;
}

}  // namespace limen
