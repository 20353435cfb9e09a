// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/waves.h"

#include <algorithm>
#include <set>
#include <tuple>
#include <utility>

#include "limen/project/project_graph.h"

namespace limen {
namespace {

constexpr std::size_t kFirstPartners = 6;
constexpr std::size_t kMorePartners = 4;
constexpr int kMostWaves = 3;
constexpr double kNearM = 12.0;  // stations nearer than this may see the same
constexpr int kEnoughLinks = 4;  // verified ones: a scan that has them needs no more

class Waves {
 public:
  Waves(const std::vector<ProjectNode>& nodes, const UserWords& words, double risk, int pairs_per_scan,
        const PairTrier& try_all)
      : nodes_(nodes), words_(words), risk_(risk), pairs_per_scan_(pairs_per_scan), try_all_(try_all) {}

  std::vector<TriedPair> run() {
    std::vector<ScanDigest> digests;
    for (const ProjectNode& node : nodes_) digests.push_back(node.digest);
    const std::vector<std::vector<std::size_t>> ranked = ranked_partners(digests);
    std::vector<TriedPair> tried = try_all_(best_pairs(ranked, kFirstPartners));
    const auto most = static_cast<std::size_t>(pairs_per_scan_) * nodes_.size();
    for (int wave = 1; wave <= kMostWaves; ++wave) {
      PairList next =
          next_pairs(ranked, tried, kFirstPartners + static_cast<std::size_t>(wave) * kMorePartners);
      if (tried.size() >= most) break;
      next.resize(std::min(next.size(), most - tried.size()));
      if (next.empty()) break;
      for (TriedPair& pair : try_all_(next)) tried.push_back(std::move(pair));
    }
    std::sort(tried.begin(), tried.end(), by_nodes);
    return tried;
  }

 private:
  [[nodiscard]] PairList next_pairs(const std::vector<std::vector<std::size_t>>& ranked,
                                    const std::vector<TriedPair>& tried, std::size_t partners) const {
    const ProjectGraph made = make_graph(nodes_, tried, risk_, words_);
    const SolvedGraph solved = solve_graph(made.graph, risk_);
    std::set<std::pair<std::size_t, std::size_t>> done;
    for (const TriedPair& pair : tried) done.emplace(pair.source, pair.target);
    std::vector<int> held(nodes_.size(), 0);
    for (std::size_t k = 0; k < made.graph.links.size(); ++k) {
      if (solved.links[k].state != LinkState::verified) continue;
      ++held[static_cast<std::size_t>(made.graph.links[k].source)];
      ++held[static_cast<std::size_t>(made.graph.links[k].target)];
    }
    // By how near they stand, then by name.
    std::vector<std::tuple<double, std::size_t, std::size_t>> wanted;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (done.count({i, j}) > 0 || solved.nodes[i].component < 0) continue;
        if (solved.nodes[i].component != solved.nodes[j].component) continue;
        const double apart = (solved.nodes[i].frame_from_node * nodes_[i].digest.middle -
                              solved.nodes[j].frame_from_node * nodes_[j].digest.middle)
                                 .norm();
        if (apart < kNearM && (held[i] < kEnoughLinks || held[j] < kEnoughLinks))
          wanted.emplace_back(apart, i, j);
      }
      if (held[i] > 0) continue;
      for (std::size_t k = 0; k < std::min(partners, ranked[i].size()); ++k) {
        const std::pair pair(std::max(i, ranked[i][k]), std::min(i, ranked[i][k]));
        if (done.count(pair) == 0) wanted.emplace_back(kNearM, pair.first, pair.second);
      }
    }
    std::sort(wanted.begin(), wanted.end());
    PairList next;
    for (const auto& [apart, i, j] : wanted) {
      if (done.emplace(i, j).second) next.emplace_back(i, j);
    }
    return next;
  }

  const std::vector<ProjectNode>& nodes_;
  const UserWords& words_;
  double risk_;
  int pairs_per_scan_;
  const PairTrier& try_all_;
};

}  // namespace

std::vector<TriedPair> try_in_waves(const std::vector<ProjectNode>& nodes, const UserWords& words,
                                    double risk, int pairs_per_scan, const PairTrier& try_all) {
  return Waves(nodes, words, risk, pairs_per_scan, try_all).run();
}

bool by_nodes(const TriedPair& a, const TriedPair& b) {
  return std::pair(a.source, a.target) < std::pair(b.source, b.target);
}

}  // namespace limen
