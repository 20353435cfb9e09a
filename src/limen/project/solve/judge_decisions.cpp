// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/solve/judge_decisions.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "limen/base/angles.h"
#include "limen/base/named.h"
#include "limen/project/solve/project_graph.h"
#include "limen/project/solve/word_terms.h"
#include "limen/register/judge/start_prior.h"

namespace limen {
namespace {

constexpr double kSamePlaceM = 0.05;  // a rejected link that others put so near is not wrong
constexpr double kJudgedTurnRad = 0.01;

class DecisionJudge {
 public:
  explicit DecisionJudge(const WordsAndSolution& all)
      : all_(all), idle_(idle_words(all.words, all.nodes, all.solved, all.controlled)) {}

  [[nodiscard]] std::vector<ProjectDecision> run() const {
    std::vector<ProjectDecision> list;
    for (std::size_t d = 0; d < all_.words.decisions.size(); ++d) {
      ProjectDecision stated;
      stated.decision = all_.words.decisions[d];
      if (idle_[d].empty())
        judge(all_.words.nodes[d], d < all_.broken.size() && all_.broken[d], stated);
      else
        stated.reason = idle_[d];
      list.push_back(stated);
    }
    return list;
  }

 private:
  [[nodiscard]] const ScanDigest& digest(int node) const {
    return all_.nodes[static_cast<std::size_t>(node)].digest;
  }

  void judge(const std::vector<int>& nodes, bool broken, ProjectDecision& stated) const {
    const DecisionKind kind = stated.decision.kind;
    if (nodes.empty()) {
      stated.reason = "the project has no such scan, or several of that name";
      return;
    }
    if (kind == DecisionKind::level || kind == DecisionKind::same_floor) {
      stated.state = broken ? DecisionState::contradicted : DecisionState::kept;
      if (broken) stated.reason = "links and planes contradict it, so it was not applied";
      return;
    }
    if (kind == DecisionKind::reject) return judge_rejection(nodes, stated);
    if (kind == DecisionKind::start) return judge_start(nodes, stated);
    for (std::size_t k = 0; k < all_.graph.links.size(); ++k) {
      const GraphLink& link = all_.graph.links[k];
      if (all_.pair_of[k] < 0 || std::minmax(link.source, link.target) != std::minmax(nodes[0], nodes[1]))
        continue;
      if (link.best != stated.decision.pose) break;
      const bool taken = all_.solved.links[k].pose == 0;
      stated.state = taken ? DecisionState::kept : DecisionState::contradicted;
      if (!taken) stated.reason = words_of_contradiction(link);
      return;
    }
    stated.reason = "the pair has no such pose";
  }

  /// By how much the others put the two elsewhere than the pose that was chosen.
  [[nodiscard]] std::string words_of_contradiction(const GraphLink& link) const {
    const SolvedNode& source = all_.solved.nodes[static_cast<std::size_t>(link.source)];
    const SolvedNode& target = all_.solved.nodes[static_cast<std::size_t>(link.target)];
    if (source.component < 0 || source.component != target.component)
      return "the other links of the two scans disagree with it";
    const Rigid3 pose = inverse(target.frame_from_node) * source.frame_from_node;
    const Rigid3& chosen = link.poses.front().target_from_source;
    const Vector3d middle = digest(link.source).middle;
    return fmt::format("the other links disagree with it by {:.0f} mm and {:.2f} deg",
                       1e3 * (pose * middle - chosen * middle).norm(),
                       degrees(rotation_angle(chosen.rotation.transpose() * pose.rotation)));
  }

  /// Whether the two stand near where the points that were shown put them.
  void judge_start(const std::vector<int>& nodes, ProjectDecision& stated) const {
    const int target_node = std::min(nodes[0], nodes[1]);
    const int source_node = std::max(nodes[0], nodes[1]);
    const StartPrior& start =
        all_.words.starts.at({static_cast<std::size_t>(source_node), static_cast<std::size_t>(target_node)});
    const SolvedNode& source = all_.solved.nodes[static_cast<std::size_t>(source_node)];
    const SolvedNode& target = all_.solved.nodes[static_cast<std::size_t>(target_node)];
    if (source.component < 0 || source.component != target.component) {
      stated.reason = "nothing joins the two scans, there or elsewhere";
      return;
    }
    const ScanDigest& from = digest(source_node);
    StartPrior local = start;
    local.target_from_source =
        to_local(start.target_from_source, from.local_origin, digest(target_node).local_origin);
    const Rigid3 pose = inverse(target.frame_from_node) * source.frame_from_node;
    const StartAgreement miss = miss_of_start(local, pose, from.middle);
    stated.state = miss.refuted() ? DecisionState::contradicted : DecisionState::kept;
    if (miss.refuted())
      stated.reason = fmt::format("the scans fit elsewhere, {:.1f} m and {:.0f} deg off", miss.shift_m,
                                  degrees(miss.turn_rad));
  }

  /// Whether the two stand as the rejected link has it all the same.
  void judge_rejection(const std::vector<int>& nodes, ProjectDecision& stated) const {
    stated.reason = "the pair has no link";
    for (const TriedPair& pair : all_.pairs) {
      const std::pair own(static_cast<int>(pair.target), static_cast<int>(pair.source));
      if (pair.placed || own != std::pair(std::min(nodes[0], nodes[1]), std::max(nodes[0], nodes[1])))
        continue;
      if (!makes_link(pair.result, true)) return;
      stated.state = DecisionState::kept;
      stated.reason = {};
      const SolvedNode& source = all_.solved.nodes[pair.source];
      const SolvedNode& target = all_.solved.nodes[pair.target];
      if (source.component < 0 || source.component != target.component) return;
      const Rigid3 rejected = to_local(pair.result.best.target_from_source, digest(own.second).local_origin,
                                       digest(own.first).local_origin);
      const Rigid3 missed = inverse(rejected) * inverse(target.frame_from_node) * source.frame_from_node;
      const Vector3d middle = digest(own.second).middle;
      if ((missed * middle - middle).norm() > kSamePlaceM || rotation_angle(missed.rotation) > kJudgedTurnRad)
        return;
      stated.state = DecisionState::contradicted;
      stated.reason = "the other links still lead to this relative pose";
      return;
    }
  }

  const WordsAndSolution& all_;
  std::vector<std::string> idle_;
};

}  // namespace

const char* to_string(DecisionState state) {
  static constexpr Named<DecisionState> names[] = {{DecisionState::kept, "kept"},
                                                   {DecisionState::contradicted, "contradicted"},
                                                   {DecisionState::unused, "unused"}};
  return name_of(names, state);
}

std::vector<ProjectDecision> judged_decisions(const WordsAndSolution& all) {
  return DecisionJudge(all).run();
}

}  // namespace limen
