// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "limen/base/angles.h"
#include "limen/base/disjoint_sets.h"
#include "limen/base/progress.h"
#include "limen/geometry/linear.h"
#include "limen/project/graph/bridges.h"
#include "limen/project/graph/doubt.h"
#include "limen/project/graph/grow_parts.h"
#include "limen/project/graph/hear_around.h"
#include "limen/project/graph/hear_beyond.h"
#include "limen/project/graph/loops.h"
#include "limen/project/graph/pose_adjustment.h"
#include "limen/project/graph/pose_graph.h"
#include "limen/project/graph/refuted_places.h"
#include "limen/project/graph/rivals.h"

namespace limen {
namespace {

constexpr int kAcceptRounds = 4;     // of accepting links and adjusting
constexpr double kFirstGate = 16.0;  // times the bound, before the first adjustment
constexpr std::size_t kLoopsPerLink = 8;
constexpr double kFixedM = 0.05;  // a weak link's node that is known this well by several is held after all
constexpr double kFixedRad = 0.01;
constexpr int kTakenBack = 3;       // times that links are taken back
constexpr double kGivesWayM = 0.5;  // what misses by more shows another place
const double kGivesWayRad = radians(5.0);
constexpr double kTellsNothing = 1e6;  // variance of an edge that is there to be told
constexpr int kMostGrown = 30;         // times that parts are grown anew
constexpr double kAsLittleNats = 0.5;  // sides that are held by no more than this above the least go together
constexpr double kLeastDoubt = 1e-6;   // no side is held more surely
constexpr double kRather = 0.5;        // probability of a twin above which it is the explanation

class Solver {
 public:
  Solver(const PoseGraph& graph, double risk, const PoseHearing& hearing, double probable_risk)
      : graph_(graph), risk_(risk), probable_risk_(probable_risk), hearing_(hearing) {
    solved_.nodes.resize(static_cast<std::size_t>(graph.nodes));
    solved_.links.resize(graph.links.size());
    left_out_.resize(graph.links.size(), false);
  }

  SolvedGraph run() {
    votes_ = loop_votes(graph_);
    grow();
    settle();
    for (int taken = 0; take_apart_twins(); ++taken) {
      // What hung on links that are left out may hang on others.
      if (taken < kMostGrown) grow();
      settle();
    }
    adjust(true);
    number_components();
    judge_nodes();
    solved_.questions = rival_places(graph_, accepted_);
    hear_the_others();
    drop_settled_questions();
    heed_questions();
    heed_doubts();
    judge_links();
    solved_.loops = tested_loops(graph_, accepted_.pose, kLoopsPerLink);
    return std::move(solved_);
  }

 private:
  void grow() {
    grown_ = grow_parts(graph_, votes_, left_out_);
    accepted_.frame_from_node = grown_.part_from_node;
    accepted_.component = grown_.part;
    accepted_.pose.assign(graph_.links.size(), -1);
  }

  void settle() {
    std::vector<int> adjusted;
    for (int round = 0; round < kAcceptRounds; ++round) {
      accept(round == 0 ? kFirstGate : round + 1 < kAcceptRounds ? 4.0 : 1.0);
      settle_components();
      if (accepted_.pose == adjusted) continue;
      adjust(false);
      adjusted = accepted_.pose;
    }
    accept(1.0);
    settle_components();
    for (int round = 0; round < kTakenBack && take_back(); ++round) {
      adjust(false);
      accept(1.0);
      settle_components();
    }
  }

  /// Links that miss what was solved without them by no more than the solution is open there: each would have
  /// been accepted, had it come first. Whether there are any.
  bool take_back() {
    std::vector<PoseEdge> list = edges();
    const std::size_t accepted = list.size();
    std::vector<std::pair<std::size_t, int>> near;  // links and poses
    for (std::size_t k = 0; k < graph_.links.size(); ++k) {
      const GraphLink& link = graph_.links[k];
      if (accepted_.pose[k] >= 0 || left_out_[k] || link.trust == LinkTrust::weak) continue;
      if (component(link.source) != component(link.target)) continue;
      const std::size_t count = link.trust <= LinkTrust::likely ? 1 : link.poses.size();
      for (std::size_t p = 0; p < count; ++p) {
        const Vector6d missed = misfit(link.poses[p], predicted(link));
        if (missed.head<3>().norm() > kGivesWayRad || missed.tail<3>().norm() > kGivesWayM) continue;
        near.emplace_back(k, static_cast<int>(p));
        PoseEdge edge{link.source, link.target, link.poses[p]};
        edge.pose.covariance = kTellsNothing * Matrix6d::Identity();
        list.push_back(edge);
      }
    }
    if (near.empty()) return false;
    const PoseAdjustment adjusted = adjust_from_references(list, {false, true});
    std::map<std::size_t, double> nearest;
    for (std::size_t i = 0; i < near.size(); ++i) {
      const auto& [k, p] = near[i];
      const LinkPose& pose = graph_.links[k].poses[static_cast<std::size_t>(p)];
      const double squared = chi_square(misfit(pose, predicted(graph_.links[k])),
                                        pose.covariance + adjusted.edge_covariance[accepted + i]);
      const auto known = nearest.find(k);
      if (squared > (known == nearest.end() ? kChiSquareBound : known->second)) continue;
      nearest[k] = squared;
      accepted_.pose[k] = p;
    }
    return !nearest.empty();
  }

  /// Where two sides of the building are more probably twins than one place, what lays them on one another is
  /// left out: it would make everything else doubtful. Of each component first where least holds them
  /// together: one room that was laid on its twin makes all doubtful that it is held against. With it go
  /// sides that are held as little and that no pair joins to it. Whether any was.
  bool take_apart_twins() {
    const std::vector<int> firsts = references();
    std::vector<int> reference;
    for (int node = 0; node < graph_.nodes; ++node)
      reference.push_back(firsts[static_cast<std::size_t>(component(node))]);
    const std::vector<NodeDoubt> doubts = doubts_of(graph_, accepted_, reference);
    std::vector<int> order;
    for (int node = 0; node < graph_.nodes; ++node) {
      const NodeDoubt& doubt = doubts[static_cast<std::size_t>(node)];
      if (doubt.twin > kRather && !doubt.across.empty()) order.push_back(node);
    }
    const auto held = [&](int node) { return doubts[static_cast<std::size_t>(node)].held_nats; };
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return held(a) < held(b); });
    const std::vector<std::vector<int>> beside = paired_nodes();
    std::vector<bool> touched(static_cast<std::size_t>(graph_.nodes), false);
    std::map<int, double> loosest;  // of each component
    for (const int node : order) {
      if (touched[static_cast<std::size_t>(node)]) continue;
      const double least = loosest.emplace(component(node), held(node)).first->second;
      if (held(node) > least + kAsLittleNats) continue;
      const std::vector<int>& across = doubts[static_cast<std::size_t>(node)].across;
      const std::vector<int> side = side_of(node, across);
      if (std::any_of(side.begin(), side.end(), [&](int n) { return touched[static_cast<std::size_t>(n)]; }))
        continue;
      for (const int k : across) left_out_[static_cast<std::size_t>(k)] = true;
      for (const int n : side) {
        touched[static_cast<std::size_t>(n)] = true;
        for (const int other : beside[static_cast<std::size_t>(n)])
          touched[static_cast<std::size_t>(other)] = true;
      }
    }
    return !order.empty();
  }

  /// The nodes that a pair joins to each, whatever became of it.
  [[nodiscard]] std::vector<std::vector<int>> paired_nodes() const {
    std::vector<std::vector<int>> beside(static_cast<std::size_t>(graph_.nodes));
    for (const std::vector<GraphLink>* links : {&graph_.links, &graph_.against}) {
      for (const GraphLink& link : *links) {
        beside[static_cast<std::size_t>(link.source)].push_back(link.target);
        beside[static_cast<std::size_t>(link.target)].push_back(link.source);
      }
    }
    return beside;
  }

  /// What accepted links hold to a node without these.
  [[nodiscard]] std::vector<int> side_of(int node, const std::vector<int>& without) const {
    DisjointSets sets(static_cast<std::size_t>(graph_.nodes));
    for (std::size_t k = 0; k < graph_.links.size(); ++k) {
      if (accepted_.pose[k] >= 0 &&
          std::find(without.begin(), without.end(), static_cast<int>(k)) == without.end())
        join(sets, graph_.links[k]);
    }
    std::vector<int> side;
    for (int n = 0; n < graph_.nodes; ++n) {
      if (sets.find(static_cast<std::size_t>(n)) == sets.find(static_cast<std::size_t>(node)))
        side.push_back(n);
    }
    return side;
  }

  [[nodiscard]] Rigid3 predicted(const GraphLink& link) const {
    return inverse(at(link.target)) * at(link.source);
  }
  [[nodiscard]] const Rigid3& at(int node) const {
    return accepted_.frame_from_node[static_cast<std::size_t>(node)];
  }
  [[nodiscard]] int component(int node) const { return accepted_.component[static_cast<std::size_t>(node)]; }

  /// Of each link within a part the pose nearest to the present ones, where it is near enough.
  void accept(double gate) {
    for (std::size_t k = 0; k < graph_.links.size(); ++k) {
      const GraphLink& link = graph_.links[k];
      accepted_.pose[k] = -1;
      if (left_out_[k] || component(link.source) != component(link.target)) continue;
      double best = gate * kChiSquareBound;
      // Of a sure link the other poses are there to be told, not to be taken.
      const std::size_t count = link.trust <= LinkTrust::likely ? 1 : link.poses.size();
      for (std::size_t p = 0; p < count; ++p) {
        const double squared = chi_square(misfit(link.poses[p], predicted(link)), link.poses[p].covariance);
        if (squared > best) continue;
        best = squared;
        accepted_.pose[k] = static_cast<int>(p);
      }
    }
  }

  static void join(DisjointSets& sets, const GraphLink& link) {
    sets.join(static_cast<std::size_t>(link.source), static_cast<std::size_t>(link.target));
  }

  void settle_components() {
    DisjointSets sets(accepted_.component.size());
    for (std::size_t k = 0; k < graph_.links.size(); ++k) {
      if (accepted_.pose[k] >= 0) join(sets, graph_.links[k]);
    }
    for (std::size_t i = 0; i < accepted_.component.size(); ++i)
      accepted_.component[i] = static_cast<int>(sets.find(i));
  }

  [[nodiscard]] static bool verifies(const GraphLink& link) {
    return link.trust != LinkTrust::weak && link.trust != LinkTrust::likely;
  }

  [[nodiscard]] std::vector<PoseEdge> edges() const {
    std::vector<PoseEdge> list;
    for (std::size_t k = 0; k < graph_.links.size(); ++k) {
      if (accepted_.pose[k] < 0) continue;
      const GraphLink& link = graph_.links[k];
      list.push_back({link.source, link.target, link.poses[static_cast<std::size_t>(accepted_.pose[k])]});
    }
    return list;
  }

  /// The same without those that leave a direction free: a loop through one of them checks little. They stay
  /// in the list, from a node to itself, so that numbers
  /// agree. So do those that may lie on a twin: rooms built alike close loops too.
  [[nodiscard]] std::vector<PoseEdge> firm_edges() const {
    std::vector<PoseEdge> list = edges();
    std::size_t edge = 0;
    for (std::size_t k = 0; k < graph_.links.size(); ++k) {
      if (accepted_.pose[k] < 0) continue;
      if (!verifies(graph_.links[k])) list[edge].target = list[edge].source;
      ++edge;
    }
    return list;
  }

  /// Of each component by its lowest node: the first node of the largest part that sure links hold together,
  /// for what is in doubt against it must not lend it the frame. Of equals the one that the rest is surest
  /// of.
  [[nodiscard]] std::vector<int> references() const {
    DisjointSets sure(accepted_.component.size());
    for (std::size_t k = 0; k < graph_.links.size(); ++k) {
      const GraphLink& link = graph_.links[k];
      if (accepted_.pose[k] >= 0 && link.trust <= LinkTrust::open && link.twin <= risk_ &&
          link.chance <= risk_)
        join(sure, link);
    }
    std::vector<std::vector<int>> parts(static_cast<std::size_t>(graph_.nodes));
    for (int i = 0; i < graph_.nodes; ++i) parts[sure.find(static_cast<std::size_t>(i))].push_back(i);
    const std::vector<JoinTrust> from_larger = grown_.trust();
    const auto counted = [](const std::vector<int>& part, const std::vector<JoinTrust>& trust) {
      return std::count_if(part.begin(), part.end(), [&](int node) {
        return trust[static_cast<std::size_t>(node)] <= JoinTrust::likely;
      });
    };
    using Weight = std::pair<std::ptrdiff_t, std::ptrdiff_t>;
    std::vector<int> first(static_cast<std::size_t>(graph_.nodes), -1);
    std::vector<Weight> most(first.size());
    for (const std::vector<int>& part : parts) {
      if (part.empty()) continue;
      const auto home = static_cast<std::size_t>(component(part.front()));
      if (static_cast<std::ptrdiff_t>(part.size()) < most[home].first) continue;
      const auto firm = std::find_if(part.begin(), part.end(), [&](int node) {
        return from_larger[static_cast<std::size_t>(node)] <= JoinTrust::likely;
      });
      const int candidate = firm == part.end() ? part.front() : *firm;
      const std::ptrdiff_t firm_count = counted(part, from_larger);
      const bool all_firm = firm_count == static_cast<std::ptrdiff_t>(part.size());
      // Every node is sure of itself.
      const std::ptrdiff_t count = all_firm || part.size() == 1 ? static_cast<std::ptrdiff_t>(part.size())
                                                                : counted(part, grown_.trust_from(candidate));
      const Weight weight{count, firm_count};
      const bool earlier = weight == most[home] && candidate < first[home];
      if (first[home] >= 0 && weight <= most[home] && !earlier) continue;
      first[home] = candidate;
      most[home] = weight;
    }
    if (graph_.anchor >= 0 && component(graph_.anchor) >= 0)
      first[static_cast<std::size_t>(component(graph_.anchor))] = graph_.anchor;
    return first;
  }

  PoseAdjustment adjust_from_references(const std::vector<PoseEdge>& list,
                                        const PoseAdjustmentOptions& options) const {
    const std::vector<int> references_of = references();
    std::vector<bool> fixed(static_cast<std::size_t>(graph_.nodes), false);
    for (const int reference : references_of) {
      if (reference >= 0) fixed[static_cast<std::size_t>(reference)] = true;
    }
    // About the reference, so that it is the frame.
    std::vector<Rigid3> start = accepted_.frame_from_node;
    for (int i = 0; i < graph_.nodes; ++i) {
      const int reference = references_of[static_cast<std::size_t>(component(i))];
      start[static_cast<std::size_t>(i)] = inverse(at(reference)) * at(i);
    }
    for (const int reference : references_of) {
      if (reference >= 0) start[static_cast<std::size_t>(reference)] = Rigid3{};
    }
    return adjust_poses(start, fixed, list, options);
  }

  void adjust(bool last) {
    PoseAdjustment adjusted = adjust_from_references(edges(), {!last, last});
    accepted_.frame_from_node = std::move(adjusted.frame_from_node);
    if (!last) return;
    covariance_ = std::move(adjusted.covariance);
    bridge_ = bridges_of(graph_.nodes, firm_edges());
    edge_covariance_ = std::move(adjusted.edge_covariance);
  }

  /// The largest component first; single nodes belong to none.
  void number_components() {
    std::map<int, int> sizes;
    for (const int root : accepted_.component) ++sizes[root];
    std::vector<std::pair<int, int>> order;
    for (const auto& [root, size] : sizes) {
      if (size > 1) order.emplace_back(-size, root);
    }
    std::sort(order.begin(), order.end());
    std::map<int, int> number;
    for (std::size_t k = 0; k < order.size(); ++k) number[order[k].second] = static_cast<int>(k);
    solved_.components = static_cast<int>(order.size());
    const std::vector<int> first = references();
    for (const auto& [size, root] : order) reference_of_.push_back(first[static_cast<std::size_t>(root)]);
    for (int& root : accepted_.component) root = number.count(root) > 0 ? number[root] : -1;
  }

  void judge_nodes() {
    std::vector<std::vector<JoinTrust>> trusts;  // of each component
    for (const int reference : reference_of_) trusts.push_back(grown_.trust_from(reference));
    for (std::size_t i = 0; i < solved_.nodes.size(); ++i) {
      SolvedNode& node = solved_.nodes[i];
      node.component = accepted_.component[i];
      if (node.component < 0) continue;
      node.frame_from_node = accepted_.frame_from_node[i];
      node.covariance = covariance_[i];
      const Vector6d variances = node.covariance.diagonal();
      const bool held = variances.head<3>().maxCoeff() < kFixedRad * kFixedRad &&
                        variances.tail<3>().maxCoeff() < kFixedM * kFixedM;
      // Of what a weak link joined the covariance tells whether other links hold it by now.
      const JoinTrust trust = trusts[static_cast<std::size_t>(node.component)][i];
      node.state = trust == JoinTrust::open ? NodeState::ambiguous : NodeState::registered;
      if (node.state == NodeState::registered && !held) node.state = NodeState::under_constrained;
    }
  }

  /// Of each node the node that lends its component the frame, -1: none.
  [[nodiscard]] std::vector<int> reference_of_nodes() const {
    std::vector<int> reference(solved_.nodes.size(), -1);
    for (std::size_t i = 0; i < reference.size(); ++i) {
      if (solved_.nodes[i].component >= 0)
        reference[i] = reference_of_[static_cast<std::size_t>(solved_.nodes[i].component)];
    }
    return reference;
  }

  /// All that stand around a node are asked of its place, not only those that a link holds it to.
  void hear_the_others() {
    if (!hearing_) return;
    const std::vector<int> reference = reference_of_nodes();
    const std::vector<NodeDoubt> doubts = doubts_of(graph_, accepted_, reference);
    const std::vector<double> apart = odds_of_standing_apart(doubts, reference);
    std::vector<double> total(doubts.size(), 1.0);
    for (std::size_t i = 0; i < total.size(); ++i) {
      if (reference[i] >= 0 && solved_.nodes[i].state != NodeState::ambiguous)
        total[i] = doubts[i].where_few_stand_apart(apart[i]).total();
    }
    accepted_.heard = hear_around(graph_, accepted_, total, risk_, hearing_);
    std::vector<bool> firm(total.size(), false);
    for (std::size_t i = 0; i < total.size(); ++i) firm[i] = total[i] <= risk_;
    const std::vector<NodeDoubt> heard = doubts_of(graph_, accepted_, reference);
    accepted_.beyond_nats = hear_beyond(graph_, accepted_, heard, firm, risk_, hearing_);
  }

  /// What links say each for itself bounds how sure the present place is. So does the doubt of its side by
  /// the links that speak for it alone, which knows of the building what all links have taught: how seldom
  /// places are built alike, and stand apart.
  void drop_settled_questions() {
    // What a question that was settled would have moved is held: that may settle others.
    for (std::size_t open = 0; open != solved_.questions.size();) {
      open = solved_.questions.size();
      drop_questions_settled_by_the_rest();
    }
  }

  void drop_questions_settled_by_the_rest() {
    const std::vector<int> reference = reference_of_nodes();
    const std::vector<NodeDoubt> all_doubts = doubts_of(graph_, accepted_, reference);
    std::vector<NodeDoubt> doubts = all_doubts;
    for (const GraphQuestion& question : solved_.questions)
      for (const int node : seen_from_frame(question).moved)
        doubts[static_cast<std::size_t>(node)].chance = 1.0;  // not held
    const std::vector<double> apart = odds_of_standing_apart(doubts, reference);
    const std::vector<bool> firm = unquestioned_nodes(all_doubts, apart, reference);
    const auto settled = [&](const GraphQuestion& asked) {
      // What was heard of a place speaks of the side without the node that lends the frame.
      const GraphQuestion question = seen_from_frame(asked);
      std::vector<bool> side(solved_.nodes.size(), false);
      double odds = 0.0;
      for (const int node : question.moved) {
        side[static_cast<std::size_t>(node)] = true;
        odds = std::max(odds, apart[static_cast<std::size_t>(node)]);
      }
      AcceptedPoses telling = accepted_;
      telling.beyond_nats.clear();  // said beside other links
      for (std::size_t k = 0; k < graph_.links.size(); ++k) {
        const GraphLink& link = graph_.links[k];
        const bool across =
            side[static_cast<std::size_t>(link.source)] != side[static_cast<std::size_t>(link.target)];
        const bool tells = std::find(question.current.begin(), question.current.end(), static_cast<int>(k)) !=
                           question.current.end();
        if (across && !tells) telling.pose[k] = -1;
      }
      const double doubt = doubt_of_side(graph_, telling, side).where_few_stand_apart(odds).total();
      const double lead = -std::log(std::max(doubt, kLeastDoubt)) - question.rival_nats;
      return lead >= kRivalClearNats || is_refuted(question, kRivalClearNats - lead, firm);
    };
    std::vector<GraphQuestion>& all = solved_.questions;
    all.erase(std::remove_if(all.begin(), all.end(), settled), all.end());
  }

  /// The movement as one of the side without the node that lends the frame.
  [[nodiscard]] GraphQuestion seen_from_frame(GraphQuestion question) const {
    const int home = accepted_.component[static_cast<std::size_t>(question.moved.front())];
    std::vector<bool> moves(solved_.nodes.size(), false);
    for (const int node : question.moved) moves[static_cast<std::size_t>(node)] = true;
    const int reference = reference_of_[static_cast<std::size_t>(home)];
    if (!moves[static_cast<std::size_t>(reference)]) return question;
    question.frame_from_frame = inverse(question.frame_from_frame);
    question.moved.clear();
    for (std::size_t i = 0; i < solved_.nodes.size(); ++i) {
      if (accepted_.component[i] == home && !moves[i]) question.moved.push_back(static_cast<int>(i));
    }
    return question;
  }

  /// Nodes that are not in doubt and that no question would move: what they saw of other places counts.
  [[nodiscard]] std::vector<bool> unquestioned_nodes(const std::vector<NodeDoubt>& doubts,
                                                     const std::vector<double>& apart,
                                                     const std::vector<int>& reference) const {
    std::vector<bool> firm(doubts.size(), false);
    for (std::size_t i = 0; i < firm.size(); ++i) {
      firm[i] = reference[i] >= 0 && solved_.nodes[i].state == NodeState::registered &&
                doubts[i].where_few_stand_apart(apart[i]).total() <= risk_;
    }
    for (const GraphQuestion& question : solved_.questions)
      for (const int node : seen_from_frame(question).moved) firm[static_cast<std::size_t>(node)] = false;
    return firm;
  }

  /// Whether what others saw refutes the other place of each node that would move, by so much.
  [[nodiscard]] bool is_refuted(const GraphQuestion& asked, double nats,
                                const std::vector<bool>& firm) const {
    if (!hearing_) return false;
    const GraphQuestion question = seen_from_frame(asked);
    return std::all_of(question.moved.begin(), question.moved.end(), [&](int node) {
      return nats_against_place(accepted_, node, question.frame_from_frame, firm, hearing_) >= nats;
    });
  }

  /// What might stand elsewhere is ambiguous: the side of the cut without the node that lends the frame.
  void heed_questions() {
    for (GraphQuestion& question : solved_.questions) {
      question = seen_from_frame(std::move(question));
      for (const int moved : question.moved) {
        SolvedNode& node = solved_.nodes[static_cast<std::size_t>(moved)];
        node.state = NodeState::ambiguous;
        const Rigid3 other = question.frame_from_frame * node.frame_from_node;
        const bool known =
            std::any_of(node.alternatives.begin(), node.alternatives.end(), [&](const Rigid3& a) {
              return (a.translation - other.translation).norm() < kSamePlaceM &&
                     rotation_angle(a.rotation.transpose() * other.rotation) < kSamePlaceRad;
            });
        if (!known) node.alternatives.push_back(other);
      }
      for (const int link : question.current) doubted_[link] = true;
      for (const int link : question.rival) doubted_[link] = true;
    }
  }

  /// Of each node the odds that a scan shares nothing with any other of its project, by how many others are
  /// surely held (Laplace's rule, the scan itself taken for one that does not), 1 at most. What lies on a
  /// twin shares nothing with what is around it in truth, or that would hold it there.
  [[nodiscard]] std::vector<double> odds_of_standing_apart(const std::vector<NodeDoubt>& doubts,
                                                           const std::vector<int>& reference) const {
    std::vector<bool> held(doubts.size(), false);
    for (std::size_t i = 0; i < held.size(); ++i) {
      held[i] = reference[i] >= 0 && reference[i] != static_cast<int>(i) &&
                solved_.nodes[i].state != NodeState::ambiguous && doubts[i].total() <= risk_;
    }
    const auto count = static_cast<double>(std::count(held.begin(), held.end(), true));
    std::vector<double> odds;
    for (const bool own : held) {
      const double others = count - (own ? 1.0 : 0.0);
      odds.push_back(std::min(1.0, (static_cast<double>(held.size()) - others) / (others + 1.0)));
    }
    return odds;
  }

  /// What no link holds surely enough is ambiguous; nodes that hang on the same links are one question.
  void heed_doubts() {
    const std::vector<int> reference = reference_of_nodes();
    const auto is_open = [](const SolvedNode& node) { return node.state == NodeState::under_constrained; };
    const bool any_open = std::any_of(solved_.nodes.begin(), solved_.nodes.end(), is_open);
    const std::vector<NodeDoubt> firmly = doubts_of(graph_, accepted_, reference);
    const std::vector<NodeDoubt> loosely =
        any_open ? doubts_of(graph_, accepted_, reference, {true}) : std::vector<NodeDoubt>{};
    const std::vector<double> apart = odds_of_standing_apart(firmly, reference);
    std::map<std::vector<int>, GraphQuestion> asked;
    for (std::size_t i = 0; i < firmly.size(); ++i) {
      SolvedNode& node = solved_.nodes[i];
      if (node.component < 0) continue;
      const std::vector<NodeDoubt>& doubts = is_open(node) ? loosely : firmly;
      node.doubt = doubts[i].where_few_stand_apart(apart[i]).total();
      if (node.state == NodeState::ambiguous || node.doubt <= risk_) continue;
      const bool probable = node.state == NodeState::registered && node.doubt <= probable_risk_;
      node.state = probable ? NodeState::probable : NodeState::ambiguous;
      GraphQuestion& question = asked[doubts[i].links];
      question.moved.push_back(static_cast<int>(i));
      question.current = doubts[i].links;
      question.doubt = std::max(question.doubt, node.doubt);
      for (const int link : doubts[i].links) doubted_[link] = true;
    }
    for (const auto& [links, question] : asked) solved_.questions.push_back(question);
  }

  void judge_links() {
    std::size_t edge = 0;
    for (std::size_t k = 0; k < graph_.links.size(); ++k) {
      const GraphLink& link = graph_.links[k];
      SolvedLink& solved = solved_.links[k];
      solved.pose = accepted_.pose[k];
      const bool joined = component(link.source) >= 0 && component(link.source) == component(link.target);
      if (joined) {
        const LinkPose& pose = link.poses[static_cast<std::size_t>(std::max(0, solved.pose))];
        const Vector6d missed = misfit(pose, predicted(link));
        solved.loop_error_rad = missed.head<3>().norm();
        solved.loop_error_m = missed.tail<3>().norm();
        solved.chi_square = chi_square(missed, pose.covariance);
      }
      if (solved.pose < 0) {
        solved.state = link.trust == LinkTrust::weak ? LinkState::weak
                       : link.trust > LinkTrust::sure || doubted_.count(static_cast<int>(k)) > 0
                           ? LinkState::ambiguous
                           : LinkState::rejected;
        continue;
      }
      const LinkPose& pose = link.poses[static_cast<std::size_t>(solved.pose)];
      const Matrix6d part = edge_covariance_[edge] * inverse_of(pose.covariance);
      solved.redundancy = std::clamp(6.0 - part.trace(), 0.0, 6.0);
      const bool bridge = bridge_[edge];
      ++edge;
      // What may lie on a twin is checked where its ends stand firmly without it.
      const bool firm = solved_.nodes[static_cast<std::size_t>(link.source)].state == NodeState::registered &&
                        solved_.nodes[static_cast<std::size_t>(link.target)].state == NodeState::registered;
      if (link.trust == LinkTrust::weak) {
        solved.state = LinkState::weak;
      } else if ((link.trust == LinkTrust::likely && !firm) || doubted_.count(static_cast<int>(k)) > 0 ||
                 (bridge && link.trust > LinkTrust::sure)) {
        solved.state = LinkState::ambiguous;
      } else {
        solved.state = bridge ? LinkState::bridge : LinkState::verified;
      }
    }
  }

  const PoseGraph& graph_;
  double risk_;
  double probable_risk_;
  const PoseHearing& hearing_;
  std::vector<bool> left_out_;     ///< links that would lay a place on its twin
  std::vector<int> reference_of_;  ///< of each component: the node that keeps its pose
  std::vector<std::vector<int>> votes_;
  GrownParts grown_;
  AcceptedPoses accepted_;
  std::vector<Matrix6d> covariance_;
  std::vector<Matrix6d> edge_covariance_;
  std::vector<bool> bridge_;
  std::map<int, bool> doubted_;
  SolvedGraph solved_;
};

}  // namespace

SolvedGraph solve_graph(const PoseGraph& graph, double risk, const PoseHearing& hearing,
                        double probable_risk) {
  return Solver(graph, risk, hearing, probable_risk).run();
}

}  // namespace limen
