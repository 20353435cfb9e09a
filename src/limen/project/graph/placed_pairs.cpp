// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/placed_pairs.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "limen/base/parallel.h"
#include "limen/base/ranked.h"
#include "limen/register/judge/score_pose.h"

namespace limen {
namespace {

constexpr double kLeastContactM2 = 0.1;
constexpr double kMostAskedNats = 4.0;  // for a placement that no search proposed
constexpr std::size_t kAskedAtOnce = 8;

double contact_m2(const PoseSurface& queried) {
  return queried.agreeing_m2 + queried.contradicted_m2;
}

/// How much is contradicted where a placement is right is a property of a project as well: of what moves
/// there, of glass, of how far apart its scans were taken. Learned as the median over what was asked, for
/// most of it is right.
evidence_table::Contradiction learned_contradiction(const std::vector<PoseSurface>& asked) {
  constexpr double kMostRight = 0.5;
  std::vector<double> shares;
  for (const PoseSurface& queried : asked) {
    if (contact_m2(queried) >= kLeastContactM2)
      shares.push_back(queried.contradicted_m2 / contact_m2(queried));
  }
  evidence_table::Contradiction learned = evidence_table::kPlaced;
  if (shares.empty()) return learned;
  learned.right.mean = std::clamp(median(shares), learned.right.mean, kMostRight);
  return learned;
}

/// The evidence of the contradicted share of two scans for their placement, nats.
double nats_of_contact(const PoseSurface& queried, const evidence_table::Contradiction& table) {
  if (contact_m2(queried) < kLeastContactM2) return 0.0;
  return std::min(kMostAskedNats, nats_of_contradiction(queried.agreeing_m2, queried.contradicted_m2, table));
}

/// What two scans say of a placement that no link of theirs agrees with.
PlacedPair asked_pair(int source, int target, const Rigid3& target_from_source, const PoseSurface& surface,
                      const evidence_table::Contradiction& table, const PoseQuery& query) {
  PlacedPair pair;
  pair.source = source;
  pair.target = target;
  pair.shared_m2 = surface.agreeing_m2;
  const double nats = nats_of_contact(surface, table);
  pair.evidence.chance_nats = nats;
  pair.evidence.asks_look_alike = true;
  // A look-alike place agrees by design: agreeing walls do not tell it from the right one, contradicted ones
  // do.
  LookAlikeEvidence& look_alikes = pair.evidence.look_alikes;
  look_alikes.otherwise_nats.fill(std::min(0.0, nats));
  look_alikes.alike_nats = look_alikes.otherwise_nats;
  if (nats <= 0.0 || !query.things) return pair;
  // Where a placement is known to a decimetre, things that agree say something, and others nothing.
  if (const std::optional<LookAlikeEvidence> things = query.things(source, target, target_from_source);
      things && otherwise_nats(*things) > 0.0) {
    for (std::size_t j = 0; j < kBuiltInLevels; ++j)
      look_alikes.otherwise_nats[j] = std::min(things->otherwise_nats[j], kMostAskedNats);
    look_alikes.things = look_alikes.agreeing = things->agreeing;
  }
  return pair;
}

PlacedPair linked_pair(const PoseGraph& graph, const LinkMatcher& matcher, const Configuration& configuration,
                       std::size_t k) {
  const GraphLink& link = graph.links[k];
  const int pose = configuration.pose[k];
  return {link.source, link.target, link.poses[static_cast<std::size_t>(pose)].agreeing_m2,
          matcher.evidence(k, pose), static_cast<int>(k)};
}

bool says_something(const PlacedPair& pair) {
  return pair.evidence.chance_nats != 0.0 || pair.evidence.look_alikes.otherwise_nats != NatsOfThings{};
}

}  // namespace

std::vector<PlacedPair> placed_pairs(const PoseGraph& graph, const LinkMatcher& matcher,
                                     const Configuration& configuration, const PoseQuery& query) {
  std::vector<PlacedPair> pairs;
  std::set<std::pair<int, int>> known;
  for (std::size_t k = 0; k < graph.links.size(); ++k) {
    if (configuration.pose[k] < 0) continue;
    pairs.push_back(linked_pair(graph, matcher, configuration, k));
    known.insert(std::minmax(graph.links[k].source, graph.links[k].target));
  }
  if (!query) return pairs;
  std::vector<std::pair<int, int>> asked;
  for (int target = 0; target < graph.nodes; ++target) {
    for (int source = target + 1; source < graph.nodes; ++source) {
      if (configuration.component[static_cast<std::size_t>(source)] ==
              configuration.component[static_cast<std::size_t>(target)] &&
          known.count({target, source}) == 0)
        asked.emplace_back(source, target);
    }
  }
  const auto pose = [&](std::size_t k) {
    return inverse(configuration.frame_from_node[static_cast<std::size_t>(asked[k].second)]) *
           configuration.frame_from_node[static_cast<std::size_t>(asked[k].first)];
  };
  std::vector<PoseSurface> surfaces(asked.size());
  parallel_for(asked.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      surfaces[k] = query.surface(asked[k].first, asked[k].second, pose(k));
  });
  const evidence_table::Contradiction table = learned_contradiction(surfaces);
  std::vector<PlacedPair> answers(asked.size());
  parallel_for(asked.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      answers[k] = asked_pair(asked[k].first, asked[k].second, pose(k), surfaces[k], table, query);
  });
  std::copy_if(answers.begin(), answers.end(), std::back_inserter(pairs), says_something);
  return pairs;
}

double nats_against_move(const Configuration& configuration, const std::vector<bool>& side,
                         const Rigid3& frame_from_frame, double enough, const PoseQuery& query) {
  if (!query) return 0.0;
  struct Asked {
    int moved = -1;
    int other = -1;
    Rigid3 other_from_moved;
  };
  std::vector<Asked> asked;
  for (std::size_t moved = 0; moved < side.size(); ++moved) {
    for (std::size_t other = 0; other < side.size(); ++other) {
      if (side[moved] && !side[other] && configuration.component[moved] == configuration.component[other])
        asked.push_back({static_cast<int>(moved), static_cast<int>(other),
                         inverse(configuration.frame_from_node[other]) * frame_from_frame *
                             configuration.frame_from_node[moved]});
    }
  }
  std::stable_sort(asked.begin(), asked.end(), [](const Asked& a, const Asked& b) {
    return a.other_from_moved.translation.squaredNorm() < b.other_from_moved.translation.squaredNorm();
  });
  // What several scans saw there is one observation.
  double most = 0.0;
  for (std::size_t first = 0; first < asked.size() && most < enough; first += kAskedAtOnce) {
    std::vector<double> against(std::min(kAskedAtOnce, asked.size() - first), 0.0);
    parallel_for(against.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        const Asked& pair = asked[first + k];
        against[k] = -nats_of_contact(query.surface(pair.moved, pair.other, pair.other_from_moved),
                                      evidence_table::kPlaced);
      }
    });
    most = std::max(most, *std::max_element(against.begin(), against.end()));
  }
  return most;
}

}  // namespace limen
