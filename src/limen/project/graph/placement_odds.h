// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <set>
#include <vector>

#include "limen/project/graph/as_drawn.h"
#include "limen/project/graph/learned_shares.h"
#include "limen/project/graph/look_alike_rate.h"
#include "limen/project/graph/shared_views.h"
#include "limen/project/graph/spanning_trees.h"

namespace limen {

/// Odds that a side of a component is elsewhere, against that it is where a configuration has it.
struct SideOdds {
  double look_alike = 0.0;  ///< the side lies on a look-alike place
  double alike = 0.0;       ///< the part of it that is furnished alike
  double chance = 0.0;      ///< the pairs across agree by chance
  double share = 1.0;       ///< of the ways to join the scans in which the side is joined by one pair
  std::vector<int> links;   ///< that hold it, but for those that show nothing new

  /// If one pair joins the side. `part`: of the places furnished alike, where others ask for them too.
  [[nodiscard]] double by_one_pair(double part = 1.0) const {
    return look_alike - (1.0 - part) * alike + chance;
  }
  [[nodiscard]] double total(double part = 1.0) const { return share * by_one_pair(part); }
};

/// Odds of sides, by all pairs that a configuration places in sight of each other.
///
/// Scans are joined one by one, by a tree of pairs. Any tree is as likely as any other, but that all pairs of
/// scans from one place to another count once, and each of its pairs may join a wrong place. So a side is
/// elsewhere as often as trees join it by one pair.
///
/// Look-alike places: that there is one is believed once for a side, as little as any pair believes it, and
/// as often as it happens in this building (look_alike_rate.h). What things and walls say against it adds up
/// over the pairs across; those that show the same count once together. That there are places furnished
/// alike, too, is a fact of the building: the pairs on the way to a scan ask it once together. By how much
/// scans are bent, and how many things stay where they are, is learned from the pairs on either side. Chance:
/// pairs err independently as far as they show different surface, and wrong poses agree with one another
/// seldom.
class PlacementOdds {
 public:
  /// `viewpoints`: empty where every scan has its own.
  PlacementOdds(int nodes, std::vector<PlacedPair> pairs, const std::vector<UnusedLink>& unused = {},
                const std::optional<Viewpoints>& viewpoints = {});

  [[nodiscard]] const SideOdds& of(const std::vector<bool>& side);
  /// Sides without the nodes of `reference` (of each node; -1: none) whose odds are `least` or more, among
  /// those that random trees join by one pair.
  [[nodiscard]] std::set<std::vector<bool>> likely_sides(const std::vector<int>& reference, double least);
  /// Of each node that it is elsewhere than its `reference` says (-1: it has none): the sum over all sides
  /// that it is on. Those of `found` are summed, all others estimated from random trees, until the standard
  /// error is a tenth of `risk` or of the sum.
  [[nodiscard]] std::vector<double> of_nodes(const std::vector<int>& reference,
                                             const std::set<std::vector<bool>>& found, double risk);
  /// Of a side, had these links not been, in whatever way it is joined.
  [[nodiscard]] SideOdds without(const std::vector<bool>& side, const std::vector<int>& links) const;
  /// The same of a side that these pairs alone hold, somewhere else.
  [[nodiscard]] SideOdds of_pairs(const std::vector<PlacedPair>& pairs, const std::vector<bool>& side) const;

  /// Sides on which each node may be elsewhere: alone, and on its side of the weakest cuts between it and its
  /// `reference` (of each node; -1: none).
  [[nodiscard]] std::set<std::vector<bool>> weak_sides(const std::vector<int>& reference) const;

 private:
  struct Known {
    SideOdds odds;
    bool shared = false;  ///< whether the share is counted
  };
  [[nodiscard]] Known& known_of(const std::vector<bool>& side);
  [[nodiscard]] SideOdds of_across(const std::vector<const PlacedPair*>& across,
                                   const std::vector<bool>& side) const;
  void add_look_alike(const std::vector<const PlacedPair*>& across, const std::vector<bool>& side,
                      SideOdds& odds) const;
  [[nodiscard]] BuiltBelief built_without(const std::vector<bool>& side) const;
  [[nodiscard]] double log_odds_of_chance(std::vector<const PlacedPair*> across,
                                          const std::vector<bool>& side, SideOdds& odds) const;

  int nodes_;
  Viewpoints viewpoints_;
  std::vector<PlacedPair> pairs_;
  SharedViews views_;
  SpanningTrees trees_;
  LookAlikeRate rate_;
  LearnedShares<kBendLevels> bends_;
  LearnedShares<kStayedLevels> stayed_;
  AsDrawn as_drawn_;
  std::map<std::vector<bool>, Known> known_;
};

}  // namespace limen
