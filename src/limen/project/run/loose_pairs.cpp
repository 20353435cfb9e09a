// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/run/loose_pairs.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "limen/project/graph/known_poses.h"
#include "limen/project/retrieve/choose_pairs.h"

namespace limen {
namespace {

constexpr double kLooseM = 0.02;          // deviation of the least known shift of one scan to another
constexpr double kLeastCommonM2 = 1.0;    // that two should see: one wall, or one floor, holds a direction
constexpr std::size_t kMostPartners = 8;  // of a scan

double least_known_m(const Matrix6d& covariance) {
  return std::sqrt(std::max(0.0, covariance.diagonal().tail<3>().maxCoeff()));
}

bool may_be_measured(const ProjectNode& node, const SolvedNode& solved) {
  return node.digest.scanner() && !node.digest.model && solved.component >= 0 &&
         (is_placed(solved.state) || solved.state == NodeState::under_constrained);
}

}  // namespace

std::vector<LoosePair> loose_pairs(const std::vector<ProjectNode>& nodes, const ProjectGraph& made,
                                   const UserWords& words, const SolvedGraph& solved) {
  std::set<std::pair<int, int>> linked;
  for (std::size_t k = 0; k < made.graph.links.size(); ++k) {
    const GraphLink& link = made.graph.links[k];
    if (solved.links[k].pose >= 0) linked.insert(std::minmax(link.source, link.target));
  }
  std::vector<Eigen::AlignedBox3d> boxes;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    boxes.push_back(box_of_planes(nodes[i].digest, solved.nodes[i].frame_from_node));
  // Where two are loose to one another, one of them is so to the frame.
  const double loose = kLooseM / std::sqrt(2.0);
  std::vector<std::pair<double, std::pair<int, int>>> wishes;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const SolvedNode& a = solved.nodes[i];
      const SolvedNode& b = solved.nodes[j];
      const std::pair pair(static_cast<int>(i), static_cast<int>(j));
      if (a.component != b.component || !may_be_measured(nodes[i], a) || !may_be_measured(nodes[j], b))
        continue;
      if (std::max(least_known_m(a.covariance), least_known_m(b.covariance)) < loose) continue;
      if (linked.count({pair.second, pair.first}) > 0 || words.pairs.count({i, j}) > 0) continue;
      if (!boxes[i].intersects(boxes[j])) continue;
      const double common =
          predicted_overlap(nodes[i].digest, nodes[j].digest, inverse(b.frame_from_node) * a.frame_from_node);
      if (common >= kLeastCommonM2) wishes.emplace_back(-common, pair);
    }
  }
  std::sort(wishes.begin(), wishes.end());
  std::vector<std::pair<int, int>> pairs;
  for (const auto& [less, pair] : wishes) pairs.push_back(pair);
  const std::vector<LinkPose> known = known_poses(made.graph, solved, pairs);
  std::map<int, std::size_t> partners;
  std::vector<LoosePair> chosen;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const auto [source, target] = pairs[k];
    if (least_known_m(known[k].covariance) < kLooseM) continue;
    if (std::min(partners[source], partners[target]) >= kMostPartners) continue;
    ++partners[source];
    ++partners[target];
    chosen.push_back({static_cast<std::size_t>(source), static_cast<std::size_t>(target), known[k]});
  }
  std::sort(chosen.begin(), chosen.end(), [](const LoosePair& a, const LoosePair& b) {
    return std::pair(a.source, a.target) < std::pair(b.source, b.target);
  });
  return chosen;
}

}  // namespace limen
