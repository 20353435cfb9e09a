// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/placement_odds.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "limen/base/progress.h"
#include "limen/project/graph/weakest_cut.h"

namespace limen {
namespace {

constexpr double kLeastSurfaceM2 = 1e-3;  // of a pair that shares none: a given pose has a weight too
constexpr double kHardlyFresh = 0.05;     // share of a pair's surface that no other shows

}  // namespace

PlacementOdds::PlacementOdds(int nodes, std::vector<PlacedPair> pairs, const std::vector<UnusedLink>& unused)
    : nodes_(nodes),
      pairs_(std::move(pairs)),
      views_(nodes, pairs_),
      rate_(nodes, pairs_, unused),
      bends_(nodes, pairs_) {}

double PlacementOdds::odds_of_look_alike(const std::vector<const PlacedPair*>& across,
                                         const std::vector<bool>& side) const {
  std::vector<double> surface;
  std::vector<double> things;
  for (const PlacedPair* pair : across) {
    const TwinEvidence& twins = pair->evidence.twins;
    surface.push_back(std::max(kLeastSurfaceM2, pair->shared_m2));
    things.push_back(twins.things > 0.0
                         ? twins.things
                         : std::abs(nats_of(twins.otherwise_nats)) + std::abs(nats_of(twins.alike_nats)));
  }
  const std::vector<double> of_surface = views_.shares(across, side, surface);
  const std::vector<double> of_things = views_.shares(across, side, things);
  const BendBelief bends = bends_.without(side);
  LookAlikeSum against;
  double otherwise = 0.0;
  double alike = 0.0;
  bool believed = false;  // once, as little as any pair believes it
  for (std::size_t k = 0; k < across.size(); ++k) {
    const PairEvidence& evidence = across[k]->evidence;
    against.add(evidence, of_things[k], of_surface[k], bends);
    if (across[k]->link < 0 || !evidence.looks_for_twins) continue;
    otherwise = believed ? std::min(otherwise, evidence.twins.otherwise) : evidence.twins.otherwise;
    alike = believed ? std::min(alike, evidence.twins.alike) : evidence.twins.alike;
    believed = true;
  }
  return rate_.factor(side) *
         (otherwise * std::exp(-against.against_otherwise()) + alike * std::exp(-against.against_alike()));
}

double PlacementOdds::log_odds_of_chance(std::vector<const PlacedPair*> across, const std::vector<bool>& side,
                                         SideOdds& odds) const {
  std::stable_sort(across.begin(), across.end(), [&](const PlacedPair* a, const PlacedPair* b) {
    return std::pair(a->link < 0, -a->evidence.chance_nats) <
           std::pair(b->link < 0, -b->evidence.chance_nats);
  });
  const std::vector<double> fresh = views_.fresh_shares(across, side);
  double against = 0.0;
  double first = 0.0;  // closes no loop
  for (std::size_t k = 0; k < across.size(); ++k) {
    const double coincidence = across[k]->evidence.coincidence_nats;
    against += fresh[k] * (across[k]->evidence.chance_nats + coincidence);
    first = std::max(first, fresh[k] * coincidence);
    if (across[k]->link >= 0 && fresh[k] > kHardlyFresh) odds.links.push_back(across[k]->link);
  }
  std::sort(odds.links.begin(), odds.links.end());
  return first - against;
}

const SideOdds& PlacementOdds::of(const std::vector<bool>& side) {
  const auto [known, fresh] = known_.try_emplace(side);
  if (fresh) known->second = without(side, {});
  return known->second;
}

SideOdds PlacementOdds::without(const std::vector<bool>& side, const std::vector<int>& links) const {
  CancelScope::check();
  std::vector<const PlacedPair*> across;
  for (const PlacedPair& pair : pairs_) {
    const bool crosses =
        side[static_cast<std::size_t>(pair.source)] != side[static_cast<std::size_t>(pair.target)];
    if (crosses && (pair.link < 0 || std::find(links.begin(), links.end(), pair.link) == links.end()))
      across.push_back(&pair);
  }
  return of_across(across, side);
}

SideOdds PlacementOdds::of_pairs(const std::vector<PlacedPair>& pairs, const std::vector<bool>& side) const {
  std::vector<const PlacedPair*> across;
  for (const PlacedPair& pair : pairs) across.push_back(&pair);
  return of_across(across, side);
}

SideOdds PlacementOdds::of_across(const std::vector<const PlacedPair*>& across,
                                  const std::vector<bool>& side) const {
  SideOdds odds;
  odds.chance = std::exp(log_odds_of_chance(across, side, odds));
  odds.twin = odds_of_look_alike(across, side);
  return odds;
}

std::vector<std::vector<bool>> PlacementOdds::weak_sides(const std::vector<int>& reference) const {
  std::set<std::vector<bool>> sides;
  std::vector<WeakestCut> cuts(3,
                               WeakestCut(nodes_));  // against look-alike places of either kind, and chance
  for (const PlacedPair& pair : pairs_) {
    if (pair.link < 0) continue;
    LookAlikeSum look_alike;
    look_alike.add(pair.evidence);
    cuts[0].connect(pair.source, pair.target, look_alike.against_otherwise());
    cuts[1].connect(pair.source, pair.target, look_alike.against_alike());
    cuts[2].connect(pair.source, pair.target, pair.evidence.chance_nats + pair.evidence.coincidence_nats);
  }
  for (const int root : reference) {
    for (WeakestCut& cut : cuts) {
      if (root >= 0) cut.hold(root);
    }
  }
  for (int n = 0; n < nodes_; ++n) {
    if (reference[static_cast<std::size_t>(n)] < 0 || reference[static_cast<std::size_t>(n)] == n) continue;
    CancelScope::check();
    std::vector<bool> alone(static_cast<std::size_t>(nodes_), false);
    alone[static_cast<std::size_t>(n)] = true;
    sides.insert(std::move(alone));
    for (WeakestCut& cut : cuts) {
      if (std::vector<bool> side = cut.side_of(n); !side.empty()) sides.insert(std::move(side));
    }
  }
  return {sides.begin(), sides.end()};
}

}  // namespace limen
