// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/moves.h"

#include <algorithm>
#include <set>
#include <utility>

#include "limen/base/progress.h"
#include "limen/project/graph/weakest_cut.h"

namespace limen {
namespace {

constexpr double kNoOtherPlaceRad = 0.03;
// Motions about the frame's origin, which may be far from what moves, that differ by more are not the same.
constexpr double kSameMotionM = 3.0;
constexpr double kSameMotionRad = 0.05;
constexpr double kAgreementGate = 4.0;  // times the bound: what a moved side agrees with is not settled yet

class MoveSearch {
 public:
  MoveSearch(const PoseGraph& graph, const LinkMatcher& matcher, const Configuration& configuration,
             MoveTo to)
      : graph_(graph),
        matcher_(matcher),
        present_(configuration),
        to_(to),
        links_of_(static_cast<std::size_t>(graph.nodes)) {
    for (std::size_t k = 0; k < graph.links.size(); ++k) {
      links_of_[static_cast<std::size_t>(graph.links[k].source)].push_back(k);
      links_of_[static_cast<std::size_t>(graph.links[k].target)].push_back(k);
    }
  }

  std::vector<Move> run() {
    WeakestCut cut(graph_.nodes);
    for (std::size_t k = 0; k < graph_.links.size(); ++k) {
      const int pose = present_.pose[k];
      if (pose >= 0)
        cut.connect(graph_.links[k].source, graph_.links[k].target, matcher_.evidence(k, pose).in_loop());
    }
    collect_proposals();
    std::vector<Move> moves;
    std::set<std::vector<bool>> sides;  // of the link
    for (std::size_t i = 0; i < proposals_.size(); ++i) {
      const Proposal& proposal = proposals_[i];
      const GraphLink& link = graph_.links[proposal.link];
      CancelScope::check();
      if (i == 0 || proposals_[i - 1].link != proposal.link) sides = sides_of(link, cut);
      std::set<std::vector<bool>> all = sides;
      for (const int own : {link.source, link.target}) {
        if (!has_company(proposal, own)) continue;
        if (std::vector<bool> side = side_that_goes_along(proposal, own); !side.empty())
          all.insert(std::move(side));
      }
      for (const std::vector<bool>& side : all) {
        Move move = move_of(side, link, link.poses[proposal.pose].target_from_source);
        if (!move.present.empty()) moves.push_back(std::move(move));
      }
    }
    return moves;
  }

 private:
  /// A pose of a link where the configuration has another one.
  struct Proposal {
    std::size_t link = 0;
    std::size_t pose = 0;
  };
  /// How an end of a proposal's link would move.
  struct EndMotion {
    std::size_t link = 0;
    Rigid3 motion;
  };

  void collect_proposals() {
    for (std::size_t k = 0; k < graph_.links.size(); ++k) {
      const GraphLink& link = graph_.links[k];
      if (!present_.joins(link) || link.trust == LinkTrust::weak || link.trust == LinkTrust::given) continue;
      for (std::size_t p = 0; p < link.poses.size(); ++p) {
        if (static_cast<int>(p) == present_.pose[k] || matcher_.is_left_out(k, p)) continue;
        if (matcher_.evidence(k, static_cast<int>(p)).alone() <= 0.0 || !is_asked_for(link, link.poses[p]))
          continue;
        proposals_.push_back({k, p});
        for (const bool source_moves : {true, false})
          motions_.push_back({k, motion_of(link, link.poses[p].target_from_source, source_moves)});
      }
    }
    std::stable_sort(motions_.begin(), motions_.end(), [](const EndMotion& a, const EndMotion& b) {
      return a.motion.translation.x() < b.motion.translation.x();
    });
  }

  /// Whether another link proposes about the same motion: without looking at all links.
  [[nodiscard]] bool has_company(const Proposal& proposal, int own) const {
    const GraphLink& link = graph_.links[proposal.link];
    const Rigid3 motion = motion_of(link, link.poses[proposal.pose].target_from_source, own == link.source);
    auto other = std::lower_bound(motions_.begin(), motions_.end(), motion.translation.x() - kSameMotionM,
                                  [](const EndMotion& a, double x) { return a.motion.translation.x() < x; });
    for (; other != motions_.end() && other->motion.translation.x() < motion.translation.x() + kSameMotionM;
         ++other) {
      if (other->link != proposal.link &&
          (other->motion.translation - motion.translation).norm() < kSameMotionM &&
          rotation_angle(other->motion.rotation.transpose() * motion.rotation) < kSameMotionRad)
        return true;
    }
    return false;
  }

  [[nodiscard]] const Rigid3& at(int node) const {
    return present_.frame_from_node[static_cast<std::size_t>(node)];
  }

  [[nodiscard]] bool is_asked_for(const GraphLink& link, const LinkPose& pose) const {
    const Vector6d missed = misfit(pose, present_.target_from_source(link));
    if (chi_square(missed, pose.covariance) <= kChiSquareBound) return false;
    const bool is_here =
        missed.head<3>().norm() < kNoOtherPlaceRad && missed.tail<3>().norm() < kNoOtherPlaceM;
    return is_here == (to_ == MoveTo::this_place);
  }

  /// Either end alone, and what hangs together with it.
  [[nodiscard]] std::set<std::vector<bool>> sides_of(const GraphLink& link, WeakestCut& cut) const {
    std::set<std::vector<bool>> sides;
    for (const auto& [own, other] :
         {std::pair(link.source, link.target), std::pair(link.target, link.source)}) {
      std::vector<bool> alone(present_.component.size(), false);
      alone[static_cast<std::size_t>(own)] = true;
      sides.insert(std::move(alone));
      if (std::vector<bool> side = cut.side(own, other); !side.empty()) sides.insert(std::move(side));
    }
    return sides;
  }

  /// How a side moves that has one end of the link, where the pose puts it.
  [[nodiscard]] Rigid3 motion_of(const GraphLink& link, const Rigid3& target_from_source,
                                 bool source_moves) const {
    return source_moves ? at(link.target) * target_from_source * inverse(at(link.source))
                        : at(link.source) * inverse(target_from_source) * inverse(at(link.target));
  }

  /// What hangs together with an end of a link if it moves to a pose of the link: other links that agree
  /// there too hold it no more than their two poses differ. Empty where there are none.
  [[nodiscard]] std::vector<bool> side_that_goes_along(const Proposal& proposal, int own) const {
    const GraphLink& link = graph_.links[proposal.link];
    const Rigid3 motion = motion_of(link, link.poses[proposal.pose].target_from_source, own == link.source);
    WeakestCut cut(graph_.nodes);
    bool others = false;
    for (std::size_t k = 0; k < graph_.links.size(); ++k) {
      const GraphLink& one = graph_.links[k];
      const int present = present_.pose[k];
      if (present < 0) continue;
      const double nats = matcher_.evidence(k, present).in_loop();
      const auto held = [&](const Rigid3& moved) {
        const int there = matcher_.nearest(k, moved, kAgreementGate);
        if (there < 0) return nats;
        others = others || k != proposal.link;
        return nats - matcher_.evidence(k, there).in_loop();
      };
      if (one.poses.size() < 2) {
        cut.connect(one.source, one.target, nats);
        continue;
      }
      cut.connect(one.source, one.target, held(inverse(at(one.target)) * motion * at(one.source)),
                  held(inverse(motion * at(one.target)) * at(one.source)));
    }
    return others ? cut.side(own, own == link.source ? link.target : link.source) : std::vector<bool>{};
  }

  [[nodiscard]] Move move_of(const std::vector<bool>& side, const GraphLink& link,
                             const Rigid3& target_from_source) const {
    Move move;
    move.side = side;
    move.frame_from_frame = motion_of(link, target_from_source, side[static_cast<std::size_t>(link.source)]);
    JoinEvidence now;
    JoinEvidence then;
    for (std::size_t n = 0; n < side.size(); ++n) {
      if (!side[n]) continue;
      for (const std::size_t k : links_of_[n]) weigh(k, move, now, then);
    }
    // Within one place look-alike places are no question.
    const bool here = to_ == MoveTo::this_place;
    move.present_nats = here ? now.nats_against_chance() : now.nats();
    move.moved_nats = here ? then.nats_against_chance() : then.nats();
    return move;
  }

  [[nodiscard]] bool crosses(const GraphLink& link, const std::vector<bool>& side) const {
    return present_.joins(link) &&
           side[static_cast<std::size_t>(link.source)] != side[static_cast<std::size_t>(link.target)];
  }

  [[nodiscard]] Rigid3 moved_pose(const GraphLink& link, const Move& move) const {
    const auto place = [&](int node) {
      return move.side[static_cast<std::size_t>(node)] ? move.frame_from_frame * at(node) : at(node);
    };
    return inverse(place(link.target)) * place(link.source);
  }

  void weigh(std::size_t k, Move& move, JoinEvidence& now, JoinEvidence& then) const {
    const GraphLink& link = graph_.links[k];
    if (!crosses(link, move.side)) return;
    const int present = present_.pose[k];
    const int moved =
        matcher_.nearest(k, moved_pose(link, move), to_ == MoveTo::this_place ? 1.0 : kAgreementGate);
    if (present >= 0) now.add(matcher_.evidence(k, present));
    if (moved >= 0) then.add(matcher_.evidence(k, moved));
    if (present >= 0 && moved >= 0) {
      move.either.push_back(static_cast<int>(k));
      move.either_nats += matcher_.evidence(k, moved).alone() - matcher_.evidence(k, present).alone();
    } else if (moved >= 0) {
      move.moved_alone.push_back({link.source, link.target,
                                  link.poses[static_cast<std::size_t>(moved)].agreeing_m2,
                                  matcher_.evidence(k, moved), static_cast<int>(k)});
    }
    if (present == moved) return;
    if (present >= 0) move.present.push_back(static_cast<int>(k));
    if (moved >= 0) move.moved.push_back(static_cast<int>(k));
  }

  const PoseGraph& graph_;
  const LinkMatcher& matcher_;
  const Configuration& present_;
  MoveTo to_;
  std::vector<std::vector<std::size_t>> links_of_;
  std::vector<Proposal> proposals_;  ///< link by link
  std::vector<EndMotion> motions_;   ///< of both ends of their links, along x
};

}  // namespace

std::vector<Move> proposed_moves(const PoseGraph& graph, const LinkMatcher& matcher,
                                 const Configuration& configuration, MoveTo to) {
  return MoveSearch(graph, matcher, configuration, to).run();
}

}  // namespace limen
