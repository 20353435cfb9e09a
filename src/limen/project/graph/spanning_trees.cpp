// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/spanning_trees.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <Eigen/SparseCholesky>

namespace limen {

void SpanningTrees::connect(int a, int b, double weight) {
  neighbours_[static_cast<std::size_t>(a)].push_back({b, weight});
  neighbours_[static_cast<std::size_t>(b)].push_back({a, weight});
}

std::vector<int> SpanningTrees::reached(const std::vector<int>& from, const std::vector<bool>& among) const {
  std::vector<int> nodes = from;
  std::vector<bool> known(neighbours_.size(), false);
  for (const int node : from) known[static_cast<std::size_t>(node)] = true;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    for (const Way& way : beside(nodes[k])) {
      const auto n = static_cast<std::size_t>(way.to);
      if (known[n] || !among[n]) continue;
      known[n] = true;
      nodes.push_back(way.to);
    }
  }
  return nodes;
}

double SpanningTrees::log_count(const std::vector<int>& nodes) const {
  if (nodes.size() < 2) return 0.0;
  std::vector<int> row(neighbours_.size(), -1);
  for (std::size_t k = 0; k < nodes.size(); ++k)
    row[static_cast<std::size_t>(nodes[k])] = static_cast<int>(k);
  // The Laplacian without the last node.
  const auto size = static_cast<int>(nodes.size()) - 1;
  std::vector<Eigen::Triplet<double>> entries;
  for (int k = 0; k < size; ++k) {
    for (const Way& way : beside(nodes[static_cast<std::size_t>(k)])) {
      const int other = row[static_cast<std::size_t>(way.to)];
      if (other < 0) continue;
      entries.emplace_back(k, k, way.weight);
      if (other < size) entries.emplace_back(k, other, -way.weight);
    }
  }
  Eigen::SparseMatrix<double> laplacian(size, size);
  laplacian.setFromTriplets(entries.begin(), entries.end());
  return Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(laplacian).vectorD().array().log().sum();
}

double SpanningTrees::share_of_fewest_edges(const std::vector<bool>& side) const {
  const auto first = static_cast<int>(std::find(side.begin(), side.end(), true) - side.begin());
  const std::vector<int> inside = reached({first}, side);
  if (inside.size() < static_cast<std::size_t>(std::count(side.begin(), side.end(), true))) return 0.0;
  std::vector<bool> other_side = side;
  other_side.flip();
  std::vector<int> part(side.size(), -1);  // of each node beyond the edges: which part it hangs together with
  std::vector<double> edges;               // to each part
  double log_share = log_count(inside) - log_count(reached({first}, std::vector<bool>(side.size(), true)));
  for (const int node : inside) {
    for (const Way& way : beside(node)) {
      if (side[static_cast<std::size_t>(way.to)]) continue;
      int& number = part[static_cast<std::size_t>(way.to)];
      if (number < 0) {
        const std::vector<int> beyond = reached({way.to}, other_side);
        for (const int n : beyond) part[static_cast<std::size_t>(n)] = static_cast<int>(edges.size());
        edges.push_back(0.0);
        log_share += log_count(beyond);
      }
      edges[static_cast<std::size_t>(number)] += way.weight;
    }
  }
  if (edges.empty()) return 0.0;
  for (const double count : edges) log_share += std::log(count);
  return std::exp(log_share);
}

int SpanningTrees::chosen(const std::vector<Way>& ways, RandomStream& random) {
  double sum = 0.0;
  for (const Way& way : ways) sum += way.weight;
  double left = sum * random.uniform();
  for (const Way& way : ways) {
    left -= way.weight;
    if (left < 0.0) return way.to;
  }
  return ways.back().to;
}

std::vector<int> SpanningTrees::random_tree(const std::vector<int>& roots, RandomStream& random) const {
  std::vector<int> parent(neighbours_.size(), -1);
  std::vector<bool> in_tree(neighbours_.size(), false);
  for (const int root : roots) in_tree[static_cast<std::size_t>(root)] = true;
  for (const int start : reached(roots, std::vector<bool>(neighbours_.size(), true))) {
    // A random walk to the tree; where it comes to a node again, it leaves the loop out.
    for (int at = start; !in_tree[static_cast<std::size_t>(at)];) {
      const int next = chosen(beside(at), random);
      parent[static_cast<std::size_t>(at)] = next;
      at = next;
    }
    for (int at = start; !in_tree[static_cast<std::size_t>(at)]; at = parent[static_cast<std::size_t>(at)])
      in_tree[static_cast<std::size_t>(at)] = true;
  }
  return parent;
}

}  // namespace limen
