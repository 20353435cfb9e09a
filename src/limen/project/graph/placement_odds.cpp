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
constexpr double kNegligible = 1e-6;      // odds
constexpr double kAsOne = 100.0;          // weight of a pair of one place in trees, which then seldom part it
constexpr int kTreesAtOnce = 32;
// A side that one tree in thirty joins by one pair is hardly missed by so many. Trees of large projects have
// many sides each, and fewer are drawn.
constexpr int kUsualTrees = 128;
constexpr int kUsualNodes = 64;
constexpr int kMostTrees = 512;
constexpr double kKnownWell = 0.1;  // standard error, as a share

/// The mean of a value of random trees, and its standard error.
struct Estimate {
  double sum = 0.0;
  double squares = 0.0;

  void add(double value) {
    sum += value;
    squares += value * value;
  }
  [[nodiscard]] double mean(int trees) const { return sum / trees; }
  [[nodiscard]] double error(int trees) const {
    return std::sqrt(std::max(0.0, squares / trees - mean(trees) * mean(trees)) / (trees - 1));
  }
};

/// Of the joints on the way to a node: which part of their odds of places furnished alike remains when they
/// ask once together whether the building has such places. If it has two, a scan is from either: two joints
/// of equal odds leave it in the wrong one not twice as often as one joint, but as often as one of two coins
/// shows a head. Unequal joints count as so many of the greatest odds as their sum makes.
double part_asked_once(double sum, double greatest) {
  return sum > 0.0 ? 2.0 * (1.0 - std::exp2(-sum / greatest)) * greatest / sum : 1.0;
}

/// The mean of that of a side, over the nodes on it and random trees.
struct PartAsked {
  double sum = 0.0;
  double count = 0.0;

  void add(double part) {
    sum += part;
    count += 1.0;
  }
  [[nodiscard]] double mean() const { return count > 0.0 ? sum / count : 1.0; }
};

/// Of each node of a tree the sides that its edges cut off, the node on it first.
std::map<int, std::vector<bool>> sides_of_edges(const std::vector<int>& parent) {
  std::map<int, std::vector<bool>> sides;
  for (std::size_t n = 0; n < parent.size(); ++n) {
    for (auto top = n; parent[top] >= 0; top = static_cast<std::size_t>(parent[top])) {
      std::vector<bool>& side = sides[static_cast<int>(top)];
      side.resize(parent.size(), false);
      side[n] = true;
    }
  }
  return sides;
}

int fewest_trees(int nodes) {
  return std::max(kTreesAtOnce, kUsualTrees * kUsualNodes / std::max(kUsualNodes, nodes));
}

/// The nodes that lend others the frame.
std::vector<int> lenders(const std::vector<int>& reference) {
  std::set<int> all(reference.begin(), reference.end());
  all.erase(-1);
  return {all.begin(), all.end()};
}

/// The odds beforehand of a look-alike place, of one kind: once for all pairs, and as little as any of them
/// believes it. A pair that agrees by chance believes what the others do.
double believed_once(const std::vector<const PlacedPair*>& across, double LookAlikeEvidence::*kind) {
  const auto is_asked = [](const PlacedPair* pair) {
    return pair->link >= 0 && pair->evidence.asks_look_alike;
  };
  double most = 0.0;
  for (const PlacedPair* pair : across) {
    if (is_asked(pair)) most = std::max(most, pair->evidence.look_alikes.*kind);
  }
  double least = most;
  for (const PlacedPair* pair : across) {
    if (!is_asked(pair)) continue;
    const double chance = std::min(1.0, std::exp(-pair->evidence.chance_nats));
    const double own = pair->evidence.look_alikes.*kind;
    least = std::min(least, own + chance * (most - own));
  }
  return least;
}

/// What pairs of scans from the same two places say of walls: as one pair, for they are bent in the same way.
class MeanWalls {
 public:
  void add(const BuiltEvidence& walls, double share) {
    for (std::size_t j = 0; j < kBendLevels; ++j) {
      sum_.one[j] += share * walls.one[j];
      sum_.look_alike[j] += share * walls.look_alike[j];
      sum_.as_drawn[j] += share * walls.as_drawn[j];
    }
    share_ += share;
  }
  [[nodiscard]] double share() const { return share_; }
  [[nodiscard]] BuiltEvidence walls() const {
    BuiltEvidence mean = sum_;
    for (auto* logs : {&mean.one, &mean.look_alike, &mean.as_drawn})
      for (double& log : *logs) log /= share_;
    return mean;
  }

 private:
  BuiltEvidence sum_;
  double share_ = 0.0;
};

/// Adds the odds of a side to those of each node on it.
void add_to_nodes(const std::vector<bool>& side, double more, std::vector<double>& odds) {
  for (std::size_t n = 0; n < side.size(); ++n) {
    if (side[n]) odds[n] += more;
  }
}

}  // namespace

PlacementOdds::PlacementOdds(int nodes, std::vector<PlacedPair> pairs, const std::vector<UnusedLink>& unused,
                             const std::optional<Viewpoints>& viewpoints)
    : nodes_(nodes),
      viewpoints_(viewpoints.value_or(Viewpoints(nodes))),
      pairs_(std::move(pairs)),
      views_(nodes, pairs_),
      trees_(nodes),
      rate_(viewpoints_, nodes, pairs_, unused),
      bends_(viewpoints_, nodes, pairs_, bends_beforehand(), evidence_table::kBendStrength,
             [](const PairEvidence& evidence) { return logs_of_bends(evidence.look_alikes.built); }),
      stayed_(viewpoints_, nodes, pairs_, stayed_beforehand(), evidence_table::kStayedStrength,
              [](const PairEvidence& evidence) { return logs_of_stayed(evidence.look_alikes); }),
      as_drawn_(viewpoints_, nodes, pairs_) {
  const auto joins = [](const PlacedPair& pair) {
    return pair.link >= 0 || pair.evidence.look_alikes.things > 0.0;
  };
  std::map<std::pair<int, int>, double> count;  // of the pairs from one place to another
  for (const PlacedPair& pair : pairs_)
    if (joins(pair)) count[viewpoints_.of(pair.source, pair.target)] += 1.0;
  for (const PlacedPair& pair : pairs_) {
    if (!joins(pair)) continue;
    const bool same = viewpoints_.is_same(pair.source, pair.target);
    trees_.connect(pair.source, pair.target,
                   same ? kAsOne : 1.0 / count[viewpoints_.of(pair.source, pair.target)]);
  }
}

BuiltBelief PlacementOdds::built_without(const std::vector<bool>& side) const {
  BuiltBelief belief;
  belief.bends = bends_.without(side);
  belief.as_drawn = as_drawn_.without(side, belief.bends);
  return belief;
}

void PlacementOdds::add_look_alike(const std::vector<const PlacedPair*>& across,
                                   const std::vector<bool>& side, SideOdds& odds) const {
  std::vector<double> surface;
  std::vector<double> things;
  for (const PlacedPair* pair : across) {
    const LookAlikeEvidence& look_alikes = pair->evidence.look_alikes;
    surface.push_back(std::max(kLeastSurfaceM2, pair->shared_m2));
    things.push_back(look_alikes.things > 0.0
                         ? look_alikes.things
                         : std::abs(otherwise_nats(look_alikes)) + std::abs(alike_nats(look_alikes)));
  }
  const std::vector<double> of_surface = views_.shares(across, side, surface);
  const std::vector<double> of_things = views_.shares(across, side, things);
  LookAlikeSum against(built_without(side));
  std::map<std::pair<int, int>, MeanWalls> walls;
  for (std::size_t k = 0; k < across.size(); ++k) {
    const PairEvidence& evidence = across[k]->evidence;
    if (!evidence.asks_things()) {
      against.add(evidence, of_things[k], of_surface[k]);
      continue;
    }
    against.add_things(evidence.look_alikes, of_things[k]);
    walls[viewpoints_.of(across[k]->source, across[k]->target)].add(evidence.look_alikes.built,
                                                                    of_surface[k]);
  }
  for (const auto& [viewpoints, mean] : walls) against.add_walls(mean.walls(), mean.share());
  const double otherwise = believed_once(across, &LookAlikeEvidence::otherwise);
  const double alike = believed_once(across, &LookAlikeEvidence::alike);
  const double stayed = against.stayed_nats(stayed_.without(side));
  const double rate = rate_.factor(side);
  odds.alike = rate * alike * std::exp(-against.against_alike(stayed));
  odds.look_alike = rate * otherwise * std::exp(-against.against_otherwise(stayed)) + odds.alike;
}

double PlacementOdds::log_odds_of_chance(std::vector<const PlacedPair*> across, const std::vector<bool>& side,
                                         SideOdds& odds) const {
  std::stable_sort(across.begin(), across.end(), [&](const PlacedPair* a, const PlacedPair* b) {
    return std::pair(a->link < 0, -a->evidence.chance_nats) <
           std::pair(b->link < 0, -b->evidence.chance_nats);
  });
  std::vector<double> fresh = views_.fresh_shares(across, side);
  for (std::size_t k = 0; k < across.size(); ++k)
    if (across[k]->evidence.stated) fresh[k] = 1.0;
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

PlacementOdds::Known& PlacementOdds::known_of(const std::vector<bool>& side) {
  const auto [known, fresh] = known_.try_emplace(side);
  if (fresh) known->second.odds = without(side, {});
  return known->second;
}

const SideOdds& PlacementOdds::of(const std::vector<bool>& side) {
  Known& known = known_of(side);
  if (!known.shared && known.odds.total() > kNegligible)
    known.odds.share = trees_.share_of_fewest_edges(side);
  known.shared = true;
  return known.odds;
}

std::set<std::vector<bool>> PlacementOdds::likely_sides(const std::vector<int>& reference, double least) {
  const std::vector<int> roots = lenders(reference);
  RandomStream random(0);
  std::set<std::vector<bool>> likely;
  for (int k = 0; k < fewest_trees(nodes_); ++k) {
    for (const auto& [node, side] : sides_of_edges(trees_.random_tree(roots, random))) {
      if (known_of(side).odds.by_one_pair() >= least && of(side).total() >= least) likely.insert(side);
    }
  }
  return likely;
}

std::vector<double> PlacementOdds::of_nodes(const std::vector<int>& reference,
                                            const std::set<std::vector<bool>>& found, double risk) {
  std::map<std::vector<bool>, PartAsked> parts;
  std::vector<double> odds(reference.size(), 0.0);
  for (const std::vector<bool>& side : found) {
    parts.try_emplace(side);
    add_to_nodes(side, of(side).total(), odds);
  }
  const std::vector<int> roots = lenders(reference);
  RandomStream random(0);
  std::vector<Estimate> others(reference.size());
  const auto known_well = [&](int trees) {
    for (std::size_t n = 0; n < odds.size(); ++n) {
      if (others[n].error(trees) > kKnownWell * std::max(risk, odds[n] + others[n].mean(trees))) return false;
    }
    return true;
  };
  struct Joint {
    const SideOdds* odds = nullptr;
    PartAsked* found = nullptr;
  };
  std::vector<Joint> joints(reference.size());
  int trees = 0;
  do {
    for (int k = 0; k < kTreesAtOnce; ++k, ++trees) {
      const std::vector<int> parent = trees_.random_tree(roots, random);
      for (const auto& [node, side] : sides_of_edges(parent)) {
        const auto part = parts.find(side);
        joints[static_cast<std::size_t>(node)] = {&known_of(side).odds,
                                                  part == parts.end() ? nullptr : &part->second};
      }
      const auto on_way = [&](std::size_t n, const auto& use) {
        for (; parent[n] >= 0; n = static_cast<std::size_t>(parent[n])) use(joints[n]);
      };
      for (std::size_t n = 0; n < parent.size(); ++n) {
        double sum = 0.0;
        double greatest = 0.0;
        on_way(n, [&](const Joint& joint) {
          sum += joint.odds->alike;
          greatest = std::max(greatest, joint.odds->alike);
        });
        const double part = part_asked_once(sum, greatest);
        double of_tree = 0.0;
        on_way(n, [&](const Joint& joint) {
          if (joint.found != nullptr)
            joint.found->add(part);
          else
            of_tree += joint.odds->by_one_pair(part);
        });
        others[n].add(of_tree);
      }
    }
  } while (trees < fewest_trees(nodes_) || (trees < kMostTrees && !known_well(trees)));
  for (std::size_t n = 0; n < odds.size(); ++n) odds[n] = others[n].mean(trees);
  for (const auto& [side, part] : parts) add_to_nodes(side, of(side).total(part.mean()), odds);
  return odds;
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
  add_look_alike(across, side, odds);
  return odds;
}

std::set<std::vector<bool>> PlacementOdds::weak_sides(const std::vector<int>& reference) const {
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
  return sides;
}

}  // namespace limen
