// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/project/graph/pair_evidence.h"

namespace limen {

/// A pair that a configuration places in sight of each other, and what it says of that placement.
struct PlacedPair {
  int source = -1;
  int target = -1;
  double shared_m2 = 0.0;  ///< surface that both see
  PairEvidence evidence;
  int link = -1;  ///< its number; -1: no pose of a link agrees, the scans were asked about this placement
};

/// Which pairs show the same surface: what one has said another does not say again. For one thread at a time.
class SharedViews {
 public:
  SharedViews(int nodes, const std::vector<PlacedPair>& pairs);

  /// Of each pair, all across one cut (`moved`: of every node on which side it lies), the share of its
  /// surface that no pair before it has shown.
  [[nodiscard]] std::vector<double> fresh_shares(const std::vector<const PlacedPair*>& pairs,
                                                 const std::vector<bool>& moved) const;
  /// Of each pair its weight over the weights of all that show the same: pairs of one surface count once
  /// together, each by its weight, in whatever order they are.
  [[nodiscard]] std::vector<double> shares(const std::vector<const PlacedPair*>& pairs,
                                           const std::vector<bool>& moved,
                                           const std::vector<double>& weights) const;

 private:
  struct Neighbour {
    int node = -1;
    double shared_m2 = 0.0;
  };
  void mark(int node, double surface_m2, std::vector<double>& share, bool on) const;

  std::vector<std::vector<Neighbour>> neighbours_;
  // Of each node, while a pair is asked: the share of the pair's surface that the node sees with either end.
  mutable std::vector<double> with_first_;
  mutable std::vector<double> with_second_;
};

}  // namespace limen
