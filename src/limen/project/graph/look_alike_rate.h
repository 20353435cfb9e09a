// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "limen/project/graph/configuration.h"
#include "limen/project/graph/shared_views.h"
#include "limen/project/graph/viewpoints.h"

namespace limen {

/// A link whose best pose is not part of a configuration.
struct UnusedLink {
  int source = -1;
  int target = -1;
  PairEvidence evidence;
  bool contradicted = false;  ///< the configuration has the two scans elsewhere
};

/// Links that say something of look-alike places: not those that leave a direction free, nor those that more
/// probably share nothing.
std::vector<UnusedLink> unused_links(const PoseGraph& graph, const LinkMatcher& matcher,
                                     const Configuration& configuration);

/// How often, in this building, a pose whose walls agree lays a place on a look-alike one. The share has a
/// beta distribution beforehand, for buildings differ (kRateStrength). Each place that scans were taken from
/// counts once: by the clearest link of each scan that agrees and by those that do not, as many as there are
/// of each.
class LookAlikeRate {
 public:
  LookAlikeRate(const Viewpoints& viewpoints, int nodes, const std::vector<PlacedPair>& pairs,
                const std::vector<UnusedLink>& unused);

  /// The odds of a look-alike place by all links but the pairs that cross the border of `side`, as a multiple
  /// of the odds beforehand.
  [[nodiscard]] double factor(const std::vector<bool>& side) const;

 private:
  struct Link {
    int other = -1;
    std::size_t vote = 0;
  };
  std::vector<double> others_;              ///< log of the density beforehand, and what unused links say
  std::vector<std::vector<double>> votes_;  ///< log of the likelihood of each share, by links that agree
  std::vector<std::vector<Link>> links_;    ///< those of each node ...
  std::vector<double> agreeing_;            ///< ... and their part of all its links
};

}  // namespace limen
