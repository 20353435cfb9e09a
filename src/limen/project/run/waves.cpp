// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/run/waves.h"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "limen/base/parallel.h"
#include "limen/project/retrieve/choose_pairs.h"
#include "limen/project/retrieve/join_parts.h"
#include "limen/project/solve/project_graph.h"
#include "limen/project/survey/stated_place.h"

namespace limen {
namespace {

constexpr std::size_t kFirstPartners = 4;
constexpr std::size_t kFirstStated = 3;  // where all places are stated
constexpr std::size_t kMorePartners = 3;
constexpr std::size_t kFewPairs = 500;   // a minute on two cores: all pairs of 32 scans, for any project
constexpr int kLastDoubling = 4;         // later waves add no more partners of a scan than this one
constexpr std::size_t kPairsOfWave = 2;  // of a scan, on average: the next wave knows more
constexpr int kMostStatedPairs = 4;      // of a scan, where all places are stated
constexpr int kEnoughLinks = 4;          // verified ones: a scan that has them needs no more ...
constexpr int kLeastLinks = 3;           // ... nor one that has so many and is registered

class Waves {
 public:
  Waves(const std::vector<ProjectNode>& nodes, const UserWords& words, double risk, int pairs_per_scan,
        const PairTrier& try_all)
      : nodes_(nodes), words_(words), risk_(risk), pairs_per_scan_(pairs_per_scan), try_all_(try_all) {
    for (const ProjectNode& node : nodes_) digests_.push_back(node.digest);
  }

  std::vector<TriedPair> run() {
    const std::vector<std::vector<std::size_t>> ranked = with_stated_places(ranked_partners(digests_));
    const bool all_stated = std::all_of(nodes_.begin(), nodes_.end(),
                                        [](const ProjectNode& node) { return node.stated.has_value(); });
    std::vector<TriedPair> tried = try_all_(best_pairs(ranked, all_stated ? kFirstStated : kFirstPartners));
    const int per_scan = all_stated ? std::min(kMostStatedPairs, pairs_per_scan_) : pairs_per_scan_;
    const std::size_t of_scans = static_cast<std::size_t>(per_scan) * nodes_.size();
    const std::size_t most = all_stated ? of_scans : std::max(of_scans, kFewPairs);
    for (int wave = 1; tried.size() < most; ++wave) {
      // What nothing holds is worth more with every wave.
      PairList next =
          next_pairs(ranked, tried, kFirstPartners << static_cast<unsigned>(std::min(wave, kLastDoubling)));
      next.resize(std::min({next.size(), most - tried.size(), kPairsOfWave * nodes_.size()}));
      if (next.empty()) break;
      for (TriedPair& pair : try_all_(next)) tried.push_back(std::move(pair));
    }
    std::sort(tried.begin(), tried.end(), by_nodes);
    return tried;
  }

 private:
  using Ranked = std::vector<std::vector<std::size_t>>;

  /// Of a scan whose place is stated those come first that are stated near it, and those that cannot meet it
  /// not at all.
  [[nodiscard]] Ranked with_stated_places(Ranked ranked) const {
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const std::optional<SurveyedPoint>& own = nodes_[i].stated;
      if (!own) continue;
      std::erase_if(ranked[i], [&](std::size_t j) { return !can_meet(nodes_[i], nodes_[j]); });
      const auto apart = [&](std::size_t j) {
        return nodes_[j].stated ? (nodes_[j].stated->x - own->x).norm()
                                : std::numeric_limits<double>::infinity();
      };
      std::stable_sort(ranked[i].begin(), ranked[i].end(),
                       [&](std::size_t a, std::size_t b) { return apart(a) < apart(b); });
    }
    return ranked;
  }

  using Done = std::set<std::pair<std::size_t, std::size_t>>;

  [[nodiscard]] PairList next_pairs(const std::vector<std::vector<std::size_t>>& ranked,
                                    const std::vector<TriedPair>& tried, std::size_t partners) {
    const ProjectGraph made = make_graph(nodes_, tried, words_);
    const SolvedGraph solved = solve_graph(made.graph, risk_);
    Done done;
    for (const TriedPair& pair : tried) done.emplace(pair.source, pair.target);
    std::vector<int> held(nodes_.size(), 0);
    for (std::size_t k = 0; k < made.graph.links.size(); ++k) {
      if (solved.links[k].state != LinkState::verified) continue;
      ++held[static_cast<std::size_t>(made.graph.links[k].source)];
      ++held[static_cast<std::size_t>(made.graph.links[k].target)];
    }
    PairList next = between_parts(solved, done);
    const PairList by_place = partners_by_place(solved, held, done);
    const PairList others = in_turns(by_place, joining_partners(ranked, solved, held, partners, done));
    next.insert(next.end(), others.begin(), others.end());
    return next;
  }

  /// The pairs that should join parts, from where all their scans are by now.
  [[nodiscard]] PairList between_parts(const SolvedGraph& solved, Done& done) {
    std::vector<PlacedPart> parts;
    std::map<int, std::size_t> part_of_component;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const SolvedNode& node = solved.nodes[i];
      const bool joined = node.component >= 0;
      const std::size_t part =
          joined ? part_of_component.emplace(node.component, parts.size()).first->second : parts.size();
      if (part == parts.size()) parts.emplace_back();
      parts[part].scans.push_back(i);
      parts[part].part_from_scan.push_back(joined ? node.frame_from_node : Rigid3{});
    }
    PairList pairs = joiner_.next_pairs(parts, [&](std::size_t high, std::size_t low) {
      const bool models = digests_[high].model && digests_[low].model;
      return models || done.count({high, low}) > 0 || !can_meet(nodes_[high], nodes_[low]);
    });
    done.insert(pairs.begin(), pairs.end());
    return pairs;
  }

  /// Of scans that nothing holds, or only scans that the rest does not hold either, the first in their
  /// lists: the first of each, then the second of each, and so on.
  [[nodiscard]] PairList joining_partners(const std::vector<std::vector<std::size_t>>& ranked,
                                          const SolvedGraph& solved, const std::vector<int>& held,
                                          std::size_t partners, Done& done) const {
    PairList next;
    for (std::size_t k = 0; k < partners; ++k) {
      for (std::size_t i = 0; i < nodes_.size(); ++i) {
        const int own = solved.nodes[i].component;
        if ((held[i] > 0 && own == 0) || k >= ranked[i].size()) continue;
        const std::size_t partner = ranked[i][k];
        if (held[i] > 0 && solved.nodes[partner].component == own) continue;
        if (done.emplace(std::max(i, partner), std::min(i, partner)).second)
          next.emplace_back(std::max(i, partner), std::min(i, partner));
      }
    }
    return next;
  }

  /// One of either list after the other: where there are too many for all, neither goes without.
  [[nodiscard]] static PairList in_turns(const PairList& first, const PairList& second) {
    PairList all;
    for (std::size_t k = 0; k < std::max(first.size(), second.size()); ++k) {
      if (k < first.size()) all.push_back(first[k]);
      if (k < second.size()) all.push_back(second[k]);
    }
    return all;
  }

  /// Less overlap, scan, partner.
  using Wish = std::tuple<double, std::size_t, std::size_t>;

  /// Of scans that are not held by links enough the partners that should see most of what they see, the most
  /// promising first, from where all stand by now; ties by number.
  [[nodiscard]] PairList partners_by_place(const SolvedGraph& solved, const std::vector<int>& held,
                                           Done& done) const {
    std::vector<Eigen::AlignedBox3d> boxes;
    for (std::size_t i = 0; i < nodes_.size(); ++i)
      boxes.push_back(box_of_planes(nodes_[i].digest, solved.nodes[i].frame_from_node));
    std::vector<std::vector<Wish>> of_scan(nodes_.size());
    parallel_for(nodes_.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const SolvedNode& node = solved.nodes[i];
        const int enough = node.state == NodeState::registered ? kLeastLinks : kEnoughLinks;
        if (node.component >= 0 && held[i] < enough) of_scan[i] = wishes_of(i, solved, boxes, done);
      }
    });
    std::vector<Wish> wishes;
    for (const std::vector<Wish>& one : of_scan) wishes.insert(wishes.end(), one.begin(), one.end());
    std::sort(wishes.begin(), wishes.end());
    PairList next;
    for (const auto& [less, i, j] : wishes) {
      const std::pair pair(std::max(i, j), std::min(i, j));
      if (done.insert(pair).second) next.push_back(pair);
    }
    return next;
  }

  [[nodiscard]] std::vector<Wish> wishes_of(std::size_t i, const SolvedGraph& solved,
                                            const std::vector<Eigen::AlignedBox3d>& boxes,
                                            const Done& done) const {
    const SolvedNode& node = solved.nodes[i];
    std::vector<Wish> wishes;
    for (std::size_t j = 0; j < nodes_.size(); ++j) {
      const SolvedNode& other = solved.nodes[j];
      if (i == j || other.component != node.component || !boxes[i].intersects(boxes[j])) continue;
      if (done.count({std::max(i, j), std::min(i, j)}) > 0) continue;
      const double common = predicted_overlap(nodes_[i].digest, nodes_[j].digest,
                                              inverse(other.frame_from_node) * node.frame_from_node);
      if (common >= kLeastOverlapM2) wishes.emplace_back(-common, i, j);
    }
    std::sort(wishes.begin(), wishes.end());
    wishes.resize(std::min(wishes.size(), kMorePartners));
    return wishes;
  }

  const std::vector<ProjectNode>& nodes_;
  std::vector<ScanDigest> digests_;
  PartJoiner joiner_{digests_};
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
