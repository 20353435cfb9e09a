// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "limen/base/progress.h"
#include "limen/geometry/linear.h"
#include "limen/project/graph/bridges.h"
#include "limen/project/graph/configuration.h"
#include "limen/project/graph/loops.h"
#include "limen/project/graph/moves.h"
#include "limen/project/graph/placed_pairs.h"
#include "limen/project/graph/placement_odds.h"
#include "limen/project/graph/pose_adjustment.h"
#include "limen/project/graph/pose_graph.h"

namespace limen {
namespace {

constexpr std::size_t kLoopsPerLink = 8;
constexpr double kHeldM = 0.05;  // a node whose place is known less well is under-constrained
constexpr double kHeldRad = 0.01;
constexpr double kOneAlternativeM = 0.05;
constexpr double kOneAlternativeRad = 0.0175;
constexpr double kElsewhereLikelier = 1.0;  // odds above which a side is taken to be elsewhere
constexpr double kFirmShare = 0.05;         // doubt below which a node may lend its component the frame
constexpr double kLeastListed = 0.01;       // of an alternative place, as a share of the risk, to be listed

class Solver {
 public:
  Solver(const PoseGraph& graph, double risk, double probable_risk, const PoseQuery& query)
      : graph_(graph), risk_(risk), probable_risk_(probable_risk), query_(query), matcher_(graph) {
    solved_.nodes.resize(static_cast<std::size_t>(graph.nodes));
    solved_.links.resize(graph.links.size());
  }

  SolvedGraph run() {
    best_ = best_configuration(graph_, matcher_);
    weigh();
    std::set<std::vector<int>> known = {best_.pose};  // a configuration that comes again ends the search
    while (take_apart() || move_likeliest()) {
      weigh();
      if (!known.insert(best_.pose).second) break;
    }
    choose_references();
    adjust();
    lend_by_what_is_held();
    weigh_doubts();
    add_likely_doubts();
    judge_nodes();
    number_components();
    ask_questions();
    judge_links();
    solved_.loops = tested_loops(graph_, best_.pose, kLoopsPerLink);
    return std::move(solved_);
  }

 private:
  /// A side that may be elsewhere, and where, if a place is known.
  struct Doubt {
    std::vector<bool> side;
    double odds = 0.0;
    std::vector<int> present;  ///< links that hold it
    std::optional<Move> move;
  };

  void weigh() {
    odds_.emplace(graph_.nodes, placed_pairs(graph_, matcher_, best_, query_),
                  unused_links(graph_, matcher_, best_), Viewpoints(graph_, best_));
    reference_ = references();
    cuts_.clear();
  }

  /// The first node that is least probably elsewhere.
  [[nodiscard]] int firmest_of(const std::vector<int>& nodes) {
    const auto odds = [&](int n) {
      std::vector<bool> alone(static_cast<std::size_t>(graph_.nodes), false);
      alone[static_cast<std::size_t>(n)] = true;
      return std::max(kFirmShare * risk_, odds_->of(alone).total());
    };
    return *std::min_element(nodes.begin(), nodes.end(),
                             [&](int a, int b) { return std::pair(odds(a), a) < std::pair(odds(b), b); });
  }

  /// Of each node the node that lends its component the frame; -1: it is alone. The first that is firmly
  /// held.
  [[nodiscard]] std::vector<int> references() {
    std::map<int, std::vector<int>> members;
    for (int n = 0; n < graph_.nodes; ++n) members[component(n)].push_back(n);
    std::vector<int> reference(static_cast<std::size_t>(graph_.nodes), -1);
    for (const auto& [lowest, nodes] : members) {
      if (nodes.size() < 2) continue;
      int first = firmest_of(nodes);
      if (graph_.anchor >= 0 && component(graph_.anchor) == lowest) first = graph_.anchor;
      for (const int n : nodes) reference[static_cast<std::size_t>(n)] = first;
    }
    return reference;
  }

  /// The side that is most probably elsewhere leaves its component, and may join again by what did not lay it
  /// there; whether there was one.
  bool take_apart() {
    return take_apart(odds_->weak_sides(reference_)) ||
           take_apart(odds_->likely_sides(reference_, kElsewhereLikelier));
  }

  /// The one of these, if one is.
  bool take_apart(const std::set<std::vector<bool>>& sides) {
    const std::vector<bool>* worst = nullptr;
    double most = kElsewhereLikelier;
    for (const std::vector<bool>& side : sides) {
      const double odds = odds_->of(side).total();
      if (odds <= most) continue;
      most = odds;
      worst = &side;
    }
    if (worst == nullptr) return false;
    for (std::size_t k = 0; k < graph_.links.size(); ++k) {
      const GraphLink& link = graph_.links[k];
      if (best_.joins(link) &&
          (*worst)[static_cast<std::size_t>(link.source)] != (*worst)[static_cast<std::size_t>(link.target)])
        give_up_place(k);
    }
    find_components(graph_, best_);
    join_parts(graph_, matcher_, best_);
    return true;
  }

  /// The side that is most probably at another place, which links propose, goes there; whether there was one.
  bool move_likeliest() {
    doubts_.clear();
    weigh_moves();
    const auto likeliest = std::max_element(doubts_.begin(), doubts_.end(),
                                            [](const Doubt& a, const Doubt& b) { return a.odds < b.odds; });
    if (likeliest == doubts_.end() || likeliest->odds <= kElsewhereLikelier) return false;
    for (std::size_t n = 0; n < likeliest->side.size(); ++n) {
      if (likeliest->side[n])
        best_.frame_from_node[n] = likeliest->move->frame_from_frame * best_.frame_from_node[n];
    }
    join_parts(graph_, matcher_, best_);
    return true;
  }

  /// No pose of the link lays its nodes there again, or so near that it is no other place.
  void give_up_place(std::size_t link) {
    const std::vector<LinkPose>& poses = graph_.links[link].poses;
    const Rigid3 place = best_.target_from_source(graph_.links[link]);
    for (std::size_t p = 0; p < poses.size(); ++p) {
      if (is_one_place(misfit(poses[p], place)) || best_.pose[link] == static_cast<int>(p))
        matcher_.leave_out(link, static_cast<int>(p));
    }
    best_.pose[link] = -1;
  }

  /// Whether nothing is joined to a node.
  [[nodiscard]] bool is_alone(int node) const { return reference_[static_cast<std::size_t>(node)] < 0; }
  [[nodiscard]] int component(int node) const { return best_.component[static_cast<std::size_t>(node)]; }
  [[nodiscard]] const Rigid3& at(int node) const {
    return best_.frame_from_node[static_cast<std::size_t>(node)];
  }

  /// Last least squares, about the references, with covariances.
  void adjust() {
    std::vector<PoseEdge> edges = edges_of(graph_, best_.pose);
    std::vector<PoseEdge> firm = edges;  // a loop through a link that leaves a direction free checks little
    for (std::size_t k = 0, edge = 0; k < graph_.links.size(); ++k) {
      if (best_.pose[k] < 0) continue;
      if (graph_.links[k].trust == LinkTrust::weak) firm[edge].target = firm[edge].source;
      ++edge;
    }
    solved_.in_place.clear();
    for (const PoseEdge& measured : graph_.measured_in_place) {
      solved_.in_place.push_back(lies_so(measured));
      if (solved_.in_place.back()) edges.push_back(measured);
    }
    std::vector<bool> fixed(best_.component.size(), true);
    std::vector<Rigid3> start(best_.component.size());
    for (int n = 0; n < graph_.nodes; ++n) {
      const int root = reference_[static_cast<std::size_t>(n)];
      if (root < 0) continue;
      fixed[static_cast<std::size_t>(n)] = root == n;
      start[static_cast<std::size_t>(n)] = inverse(at(root)) * at(n);
    }
    PoseAdjustment adjusted = adjust_poses(start, fixed, edges, {false, true});
    best_.frame_from_node = std::move(adjusted.frame_from_node);
    covariance_ = std::move(adjusted.covariance);
    edge_covariance_ = std::move(adjusted.edge_covariance);
    bridge_ = bridges_of(graph_.nodes, firm);
  }

  /// Whether the configuration lays two nodes where they were measured, or so near that it is no other place.
  [[nodiscard]] bool lies_so(const PoseEdge& measured) const {
    return component(measured.source) == component(measured.target) &&
           is_one_place(misfit(measured.pose, inverse(at(measured.target)) * at(measured.source)));
  }

  [[nodiscard]] bool is_held(std::size_t node) const {
    const Vector6d variances = covariance_[node].diagonal();
    return variances.head<3>().maxCoeff() < kHeldRad * kHeldRad &&
           variances.tail<3>().maxCoeff() < kHeldM * kHeldM;
  }

  /// How many of the nodes that a node lends the frame are held against it.
  [[nodiscard]] std::size_t count_held(const std::vector<int>& nodes) const {
    return static_cast<std::size_t>(std::count_if(
        nodes.begin(), nodes.end(), [&](int n) { return is_held(static_cast<std::size_t>(n)); }));
  }

  /// Where most of a component is held among itself, but not against its reference, it lends the frame.
  void lend_by_what_is_held() {
    for (const auto& [root, nodes] : members_of_references()) {
      const std::size_t held = count_held(nodes);
      if (2 * held >= nodes.size()) continue;
      std::vector<int> loose;
      std::copy_if(nodes.begin(), nodes.end(), std::back_inserter(loose),
                   [&](int n) { return !is_held(static_cast<std::size_t>(n)); });
      const std::vector<int> before = reference_;
      std::replace(reference_.begin(), reference_.end(), root, largest_part(loose).front());
      adjust();
      if (count_held(nodes) > held) continue;
      reference_ = before;
      adjust();
    }
  }

  /// The component with most placed nodes first, then the largest; single nodes belong to none.
  void number_components() {
    std::map<int, std::pair<int, int>> counts;  // placed nodes and all nodes, by the lowest one
    for (int n = 0; n < graph_.nodes; ++n) {
      if (is_alone(n)) continue;
      auto& [placed, all] = counts[component(n)];
      placed += is_placed(solved_.nodes[static_cast<std::size_t>(n)].state) ? 1 : 0;
      ++all;
    }
    std::vector<std::tuple<int, int, int>> order;
    for (const auto& [lowest, count] : counts) order.emplace_back(-count.first, -count.second, lowest);
    std::sort(order.begin(), order.end());
    std::map<int, int> number;
    for (const auto& [placed, all, lowest] : order) number.emplace(lowest, static_cast<int>(number.size()));
    solved_.components = static_cast<int>(order.size());
    for (int n = 0; n < graph_.nodes; ++n)
      solved_.nodes[static_cast<std::size_t>(n)].component = is_alone(n) ? -1 : number.at(component(n));
  }

  /// The side of a cut that the node that lends the frame is not on.
  [[nodiscard]] std::vector<bool> seen_from_frame(const std::vector<bool>& side) const {
    const auto moved = std::find(side.begin(), side.end(), true) - side.begin();
    const int root = reference_[static_cast<std::size_t>(moved)];
    return root < 0 || !side[static_cast<std::size_t>(root)] ? side : other_side(side, root);
  }
  [[nodiscard]] std::vector<bool> other_side(const std::vector<bool>& side, int inside) const {
    std::vector<bool> other(side.size(), false);
    for (int n = 0; n < graph_.nodes; ++n) {
      const auto k = static_cast<std::size_t>(n);
      other[k] = component(n) == component(inside) && !side[k];
    }
    return other;
  }

  /// A cut is the same from wherever it was found: those of all references that were tried are weighed.
  void weigh_doubts() {
    for (const std::vector<bool>& side : odds_->weak_sides(reference_)) cuts_.insert(without_first(side));
    doubts_.clear();
    for (const std::vector<bool>& cut : cuts_) {
      const std::vector<bool> side = seen_from_frame(cut);
      const SideOdds& odds = odds_->of(side);
      doubts_.push_back({side, odds.total(), odds.links, {}});
    }
    weigh_moves();
  }

  /// What no weakest cut shows: groups that many pairs join, each of which says little.
  void add_likely_doubts() {
    for (const std::vector<bool>& side : odds_->likely_sides(reference_, kFirmShare * risk_)) {
      if (!cuts_.insert(without_first(side)).second) continue;
      const SideOdds& odds = odds_->of(side);
      doubts_.push_back({side, odds.total(), odds.links, {}});
    }
  }

  /// The side of a cut that its component's first node is not on.
  [[nodiscard]] std::vector<bool> without_first(const std::vector<bool>& side) const {
    const int first = static_cast<int>(std::find(side.begin(), side.end(), true) - side.begin());
    return first == component(first) ? other_side(side, first) : side;
  }

  /// The largest part of each component that no doubt divides lends it the frame: what is in doubt against it
  /// must not.
  void choose_references() {
    std::set<std::vector<int>> tried;
    while (tried.insert(reference_).second) {
      weigh_doubts();
      lend_by_largest_part();
    }
  }

  void lend_by_largest_part() {
    for (const auto& [root, nodes] : members_of_references()) {
      const std::vector<int> part = largest_part(nodes);
      if (std::find(part.begin(), part.end(), root) == part.end())
        std::replace(reference_.begin(), reference_.end(), root, part.front());
    }
  }

  /// Of each node that lends its component the frame, but the anchor, the nodes of its component.
  [[nodiscard]] std::map<int, std::vector<int>> members_of_references() const {
    std::map<int, std::vector<int>> members;
    for (int n = 0; n < graph_.nodes; ++n) {
      const int root = reference_[static_cast<std::size_t>(n)];
      if (root >= 0 && root != graph_.anchor) members[root].push_back(n);
    }
    return members;
  }

  /// Of some nodes of one component the most that no doubt divides.
  [[nodiscard]] std::vector<int> largest_part(const std::vector<int>& nodes) const {
    std::map<std::vector<bool>, std::vector<int>> parts;  // by the doubtful sides they are on
    for (const int n : nodes) {
      std::vector<bool> sides;
      for (const Doubt& doubt : doubts_) {
        if (doubt.odds > risk_) sides.push_back(doubt.side[static_cast<std::size_t>(n)]);
      }
      parts[std::move(sides)].push_back(n);
    }
    std::vector<int> largest;
    for (const auto& [sides, part] : parts) {
      if (part.size() > largest.size() || (part.size() == largest.size() && part.front() < largest.front()))
        largest = part;
    }
    return largest;
  }

  /// Places that links propose besides: a side may be there only where it is not where it is.
  void weigh_moves() {
    for (Move& move : proposed_moves(graph_, matcher_, best_)) {
      const std::vector<bool> side = seen_from_frame(move.side);
      if (side != move.side) {
        move.side = side;
        move.frame_from_frame = inverse(move.frame_from_frame);
      }
      // What agrees with both places tells them from each other by its two poses alone.
      double odds = odds_->without(side, move.either).total() /
                    odds_->of_pairs(move.moved_alone, side).total() * std::exp(move.either_nats);
      const double least = kLeastListed * risk_;
      if (odds <= least) continue;
      odds *=
          std::exp(-nats_against_move(best_, side, move.frame_from_frame, std::log(odds / least), query_));
      if (odds <= least) continue;
      std::vector<int> present = move.present;
      doubts_.push_back({side, odds, std::move(present), std::move(move)});
    }
  }

  void judge_nodes() {
    std::set<std::vector<bool>> found;
    for (const std::vector<bool>& cut : cuts_) found.insert(seen_from_frame(cut));
    const std::vector<double> wrongly_joined = odds_->of_nodes(reference_, found, risk_);
    for (std::size_t n = 0; n < solved_.nodes.size(); ++n) {
      SolvedNode& node = solved_.nodes[n];
      if (is_alone(static_cast<int>(n))) continue;
      node.frame_from_node = best_.frame_from_node[n];
      node.covariance = covariance_[n];
      double elsewhere = wrongly_joined[n];
      for (const Doubt& doubt : doubts_) {
        if (!doubt.side[n] || !doubt.move) continue;
        elsewhere = std::max(elsewhere, doubt.odds);
        add_alternative(*doubt.move, node);
      }
      node.doubt = elsewhere / (1.0 + elsewhere);
      node.state = node.doubt > probable_risk_ ? NodeState::ambiguous
                   : !is_held(n)               ? NodeState::under_constrained
                   : node.doubt > risk_        ? NodeState::probable
                                               : NodeState::registered;
    }
    judge_references();
  }

  /// The node that lends its component the frame has no doubt of its own: it gets the state and the doubt of
  /// the surest other node.
  void judge_references() {
    const auto unsure = [](const SolvedNode& node) {
      return std::tuple(node.state == NodeState::ambiguous, node.state, node.doubt);
    };
    for (const auto& [root, nodes] : members_of_references()) {
      const SolvedNode* surest = nullptr;
      for (const int n : nodes) {
        const SolvedNode& node = solved_.nodes[static_cast<std::size_t>(n)];
        if (n != root && (surest == nullptr || unsure(node) < unsure(*surest))) surest = &node;
      }
      if (surest == nullptr) continue;
      SolvedNode& lender = solved_.nodes[static_cast<std::size_t>(root)];
      lender.state = surest->state;
      lender.doubt = surest->doubt;
    }
  }

  void add_alternative(const Move& move, SolvedNode& node) const {
    const Rigid3 other = move.frame_from_frame * node.frame_from_node;
    const bool known = std::any_of(node.alternatives.begin(), node.alternatives.end(), [&](const Rigid3& a) {
      return (a.translation - other.translation).norm() < kOneAlternativeM &&
             rotation_angle(a.rotation.transpose() * other.rotation) < kOneAlternativeRad;
    });
    if (!known) node.alternatives.push_back(other);
  }

  /// One question for each side that makes a node doubtful: the one with the largest odds.
  void ask_questions() {
    std::set<const Doubt*> asked;
    for (std::size_t n = 0; n < solved_.nodes.size(); ++n) {
      if (solved_.nodes[n].component < 0 || solved_.nodes[n].doubt <= risk_) continue;
      const Doubt* largest = nullptr;
      for (const Doubt& doubt : doubts_) {
        if (doubt.side[n] && (largest == nullptr || doubt.odds > largest->odds)) largest = &doubt;
      }
      if (largest == nullptr || !asked.insert(largest).second) continue;
      GraphQuestion question;
      for (int moved = 0; moved < graph_.nodes; ++moved) {
        if (largest->side[static_cast<std::size_t>(moved)]) question.moved.push_back(moved);
      }
      question.current = largest->present;
      if (largest->move) {
        question.rival = largest->move->moved;
        question.frame_from_frame = largest->move->frame_from_frame;
      } else {
        question.doubt = largest->odds / (1.0 + largest->odds);
      }
      for (const std::vector<int>* list : {&question.current, &question.rival})
        questioned_.insert(list->begin(), list->end());
      solved_.questions.push_back(std::move(question));
    }
  }

  void judge_links() {
    std::size_t edge = 0;
    for (std::size_t k = 0; k < graph_.links.size(); ++k) {
      const GraphLink& link = graph_.links[k];
      SolvedLink& solved = solved_.links[k];
      solved.pose = best_.pose[k];
      const bool joined = best_.joins(link);
      const bool questioned = questioned_.count(static_cast<int>(k)) > 0;
      if (joined) {
        const LinkPose& pose = link.poses[static_cast<std::size_t>(std::max(0, solved.pose))];
        take_misfit(pose, best_.target_from_source(link), solved);
      }
      if (solved.pose < 0) {
        solved.state = link.trust == LinkTrust::weak ? LinkState::weak
                       : questioned || !joined       ? LinkState::ambiguous
                                                     : LinkState::rejected;
        continue;
      }
      const LinkPose& pose = link.poses[static_cast<std::size_t>(solved.pose)];
      const Matrix6d part = edge_covariance_[edge] * inverse_of(pose.covariance);
      solved.redundancy = std::clamp(6.0 - part.trace(), 0.0, 6.0);
      const bool bridge = bridge_[edge];
      ++edge;
      solved.state = link.trust == LinkTrust::weak ? LinkState::weak
                     : !bridge                     ? LinkState::verified
                     : questioned                  ? LinkState::ambiguous
                                                   : LinkState::bridge;
    }
  }

  const PoseGraph& graph_;
  double risk_;
  double probable_risk_;
  const PoseQuery& query_;
  LinkMatcher matcher_;
  Configuration best_;
  std::optional<PlacementOdds> odds_;
  std::vector<int> reference_;
  /// Found from any reference, each as its side without the component's first node.
  std::set<std::vector<bool>> cuts_;
  std::vector<Doubt> doubts_;
  std::set<int> questioned_;
  std::vector<Matrix6d> covariance_;
  std::vector<Matrix6d> edge_covariance_;
  std::vector<bool> bridge_;
  SolvedGraph solved_;
};

}  // namespace

SolvedGraph solve_graph(const PoseGraph& graph, double risk, const PoseQuery& query, double probable_risk) {
  return Solver(graph, risk, probable_risk, query).run();
}

}  // namespace limen
