// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "limen/base/random.h"

namespace limen {

/// The ways in which nodes can be joined one by one: the spanning trees of a graph without parallel edges.
/// Each counts by the product of the weights of its edges.
class SpanningTrees {
 public:
  explicit SpanningTrees(int nodes) : neighbours_(static_cast<std::size_t>(nodes)) {}
  void connect(int a, int b, double weight = 1.0);

  /// Share of the trees in which a single edge joins `side` to the rest of its component, or to each part of
  /// the rest that hangs together without it. By Kirchhoff's theorem: the number of trees is a determinant.
  [[nodiscard]] double share_of_fewest_edges(const std::vector<bool>& side) const;

  /// Of a random tree the parent of each node; -1: a root, or no root is reached. By Wilson's algorithm.
  [[nodiscard]] std::vector<int> random_tree(const std::vector<int>& roots, RandomStream& random) const;

 private:
  struct Way {
    int to = -1;
    double weight = 1.0;
  };
  [[nodiscard]] const std::vector<Way>& beside(int node) const {
    return neighbours_[static_cast<std::size_t>(node)];
  }
  [[nodiscard]] static int chosen(const std::vector<Way>& ways, RandomStream& random);
  /// Those that are reached from `from`, of `among` only.
  [[nodiscard]] std::vector<int> reached(const std::vector<int>& from, const std::vector<bool>& among) const;
  /// Logarithm of the sum of the trees of some nodes that are connected.
  [[nodiscard]] double log_count(const std::vector<int>& nodes) const;

  std::vector<std::vector<Way>> neighbours_;
};

}  // namespace limen
