// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/shared_views.h"

#include <algorithm>
#include <utility>

namespace limen {
namespace {

/// The ends of what crosses a cut, that on the moved side first.
std::pair<std::size_t, std::size_t> ends_across(const PlacedPair& pair, const std::vector<bool>& moved) {
  const auto source = static_cast<std::size_t>(pair.source);
  const auto target = static_cast<std::size_t>(pair.target);
  return moved[source] ? std::pair(source, target) : std::pair(target, source);
}

}  // namespace

SharedViews::SharedViews(int nodes, const std::vector<PlacedPair>& pairs)
    : neighbours_(static_cast<std::size_t>(nodes)),
      with_first_(static_cast<std::size_t>(nodes), 0.0),
      with_second_(with_first_) {
  for (const PlacedPair& pair : pairs) {
    if (pair.link < 0) continue;
    neighbours_[static_cast<std::size_t>(pair.source)].push_back({pair.target, pair.shared_m2});
    neighbours_[static_cast<std::size_t>(pair.target)].push_back({pair.source, pair.shared_m2});
  }
}

void SharedViews::mark(int node, double surface_m2, std::vector<double>& share, bool on) const {
  share[static_cast<std::size_t>(node)] = on ? 1.0 : 0.0;
  for (const Neighbour& other : neighbours_[static_cast<std::size_t>(node)])
    share[static_cast<std::size_t>(other.node)] = on ? std::min(1.0, other.shared_m2 / surface_m2) : 0.0;
}

std::vector<double> SharedViews::fresh_shares(const std::vector<const PlacedPair*>& pairs,
                                              const std::vector<bool>& moved) const {
  std::vector<double> fresh;
  fresh.reserve(pairs.size());
  for (const PlacedPair* pair : pairs) {
    const auto [first, second] = ends_across(*pair, moved);
    const double surface_m2 = std::max(pair->shared_m2, 1e-3);
    mark(static_cast<int>(first), surface_m2, with_first_, true);
    mark(static_cast<int>(second), surface_m2, with_second_, true);
    double seen = 0.0;
    for (std::size_t k = 0; k < fresh.size(); ++k) {
      const auto [other_first, other_second] = ends_across(*pairs[k], moved);
      seen = std::max(seen, with_first_[other_first] * with_second_[other_second]);
    }
    fresh.push_back(1.0 - seen);
    mark(static_cast<int>(first), surface_m2, with_first_, false);
    mark(static_cast<int>(second), surface_m2, with_second_, false);
  }
  return fresh;
}

std::vector<double> SharedViews::shares(const std::vector<const PlacedPair*>& pairs,
                                        const std::vector<bool>& moved,
                                        const std::vector<double>& weights) const {
  std::vector<double> shares(pairs.size(), 0.0);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    if (weights[k] <= 0.0) continue;
    const auto [first, second] = ends_across(*pairs[k], moved);
    const double surface_m2 = std::max(pairs[k]->shared_m2, 1e-3);
    mark(static_cast<int>(first), surface_m2, with_first_, true);
    mark(static_cast<int>(second), surface_m2, with_second_, true);
    double together = 0.0;
    for (std::size_t j = 0; j < pairs.size(); ++j) {
      const auto [other_first, other_second] = ends_across(*pairs[j], moved);
      together += weights[j] * with_first_[other_first] * with_second_[other_second];
    }
    shares[k] = weights[k] / together;
    mark(static_cast<int>(first), surface_m2, with_first_, false);
    mark(static_cast<int>(second), surface_m2, with_second_, false);
  }
  return shares;
}

}  // namespace limen
