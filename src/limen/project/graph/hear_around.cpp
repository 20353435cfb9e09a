// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/hear_around.h"

#include <algorithm>
#include <set>
#include <utility>

#include "limen/base/parallel.h"
#include "limen/project/graph/refuted_places.h"

namespace limen {
namespace {

constexpr double kHeardNatsPerM2 = 1.0;
constexpr double kMostAgainstNats = 14.0;  // as sure as a link may be
constexpr double kMostOfOneNats = 7.0;     // as much as a loop that closes
constexpr double kLeastContactM2 =
    0.1;  // of surface that agrees or contradicts: less is not asked for things

using Pairs = std::vector<std::pair<int, int>>;

/// Those that no accepted link holds, the one that stands less surely first.
Pairs pairs_around(const PoseGraph& graph, const AcceptedPoses& accepted, const std::vector<double>& doubt,
                   double risk) {
  std::set<std::pair<int, int>> held;
  for (std::size_t k = 0; k < graph.links.size(); ++k) {
    const GraphLink& link = graph.links[k];
    if (accepted.pose[k] >= 0 && link.trust != LinkTrust::weak)
      held.insert(std::minmax(link.source, link.target));
  }
  for (const GraphLink& link : graph.against) {
    if (is_laid_so(link, accepted)) held.insert(std::minmax(link.source, link.target));  // speaks itself
  }
  Pairs pairs;
  for (int asked = 0; asked < graph.nodes; ++asked) {
    const auto a = static_cast<std::size_t>(asked);
    if (accepted.component[a] < 0) continue;
    for (int other = 0; other < graph.nodes; ++other) {
      const auto o = static_cast<std::size_t>(other);
      const bool surer = doubt[o] <= risk && std::pair(doubt[o], other) < std::pair(doubt[a], asked);
      if (surer && accepted.component[o] == accepted.component[a] &&
          held.count(std::minmax(asked, other)) == 0)
        pairs.emplace_back(asked, other);
    }
  }
  return pairs;
}

/// Where the node that is asked stands in the other.
Rigid3 pose_of(const std::pair<int, int>& pair, const AcceptedPoses& accepted) {
  return inverse(accepted.frame_from_node[static_cast<std::size_t>(pair.second)]) *
         accepted.frame_from_node[static_cast<std::size_t>(pair.first)];
}

struct Contact {
  PoseHeard surface;
  double otherwise_nats = 0.0;
};

Contact contact_of(const std::pair<int, int>& pair, bool in_doubt, const AcceptedPoses& accepted,
                   const PoseHearing& hearing) {
  const auto& [asked, other] = pair;
  const Rigid3 pose = pose_of(pair, accepted);
  Contact contact;
  contact.surface = hearing.surface(asked, other, pose);
  const double met_m2 = contact.surface.agreeing_m2 + contact.surface.contradicted_m2;
  if (!in_doubt || met_m2 < kLeastContactM2 || !hearing.things) return contact;
  if (const std::optional<TwinEvidence> things = hearing.things(asked, other, pose))
    contact.otherwise_nats = things->otherwise_nats;
  return contact;
}

/// What a pair says of the place of the node that is asked. Faces to the millimetre tell twins furnished
/// alike, and a pose that others found is not known so well: of these nothing is said but that walls
/// contradict.
HeardPair heard_pair(const std::pair<int, int>& pair, const AcceptedPoses& accepted, const Contact& contact,
                     bool in_doubt, bool refuted) {
  const double against = std::min(kMostAgainstNats, nats_of_contradiction(contact.surface));
  const bool speaks_for = in_doubt && !refuted && contact.surface.value_m2 > 0.0;
  const auto allowed = [&](double nats) {
    return (speaks_for ? std::min(nats, kMostOfOneNats) : std::min(nats, 0.0)) - against;
  };
  HeardPair heard;
  heard.pair.source = pair.first;
  heard.pair.target = pair.second;
  LinkPose pose;
  pose.target_from_source = pose_of(pair, accepted);
  pose.agreeing_m2 = contact.surface.agreeing_m2;
  heard.pair.poses = {pose};
  heard.pair.evidence.emplace();
  heard.pair.evidence->otherwise_nats = allowed(contact.otherwise_nats);
  heard.pair.evidence->alike_nats = -against;
  heard.chance_nats = allowed(std::max(0.0, kHeardNatsPerM2 * contact.surface.value_m2));
  return heard;
}

}  // namespace

std::vector<HeardPair> hear_around(const PoseGraph& graph, const AcceptedPoses& accepted,
                                   const std::vector<double>& doubt, double risk,
                                   const PoseHearing& hearing) {
  const Pairs pairs = pairs_around(graph, accepted, doubt, risk);
  const auto asked = [&](std::size_t k) { return static_cast<std::size_t>(pairs[k].first); };
  std::vector<Contact> contacts(pairs.size());
  parallel_for(pairs.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      contacts[k] = contact_of(pairs[k], doubt[asked(k)] > risk, accepted, hearing);
  });
  std::vector<bool> refuted(static_cast<std::size_t>(graph.nodes), false);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    if (nats_of_contradiction(contacts[k].surface) > 0.0) refuted[asked(k)] = true;
  }
  std::vector<HeardPair> heard;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    HeardPair said = heard_pair(pairs[k], accepted, contacts[k], doubt[asked(k)] > risk, refuted[asked(k)]);
    if (said.chance_nats != 0.0 || said.pair.evidence->otherwise_nats != 0.0)
      heard.push_back(std::move(said));
  }
  return heard;
}

}  // namespace limen
