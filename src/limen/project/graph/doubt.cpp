// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/doubt.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "limen/base/progress.h"
#include "limen/project/graph/flow_network.h"
#include "limen/project/graph/twin_rate.h"
#include "limen/project/graph/twins_across.h"

namespace limen {
namespace {

constexpr double kMostNats = 14.0;     // no link is surer than about one in a million
constexpr double kLoopNats = 7.0;      // a wrong pose that agrees with another link, once in a thousand ...
constexpr double kOpenLoopNats = 3.0;  // ... or one of several, which repeat what repeats in the building
constexpr double kEnoughNats = 30.0;
constexpr double kHardlyFresh = 0.05;   // share of what a link shows that no other has shown
constexpr double kMostBelieved = 0.45;  // of each kind of twin, beforehand
constexpr double kLeastAlike = 0.002;   // of those furnished alike, where there are twins (twin_odds.h)
constexpr double kMostHeardNats = 5.0;  // of pairs that hold nothing, against chance: one wrong pose in 200
constexpr double kUnits = 1000.0;       // of the flow, per nat

class DoubtSearch {
 public:
  DoubtSearch(const PoseGraph& graph, const AcceptedPoses& accepted, const DoubtOptions& options)
      : graph_(graph), accepted_(accepted), views_(graph, accepted) {
    for (std::size_t k = 0; k < graph.links.size(); ++k) {
      if (accepted.pose[k] >= 0 && (options.weak_links_hold || graph.links[k].trust != LinkTrust::weak))
        held_.push_back(static_cast<int>(k));
    }
    for (const GraphLink& pair : graph.against) {
      if (pair.evidence && is_laid_so(pair, accepted)) against_.push_back(&pair);
    }
    evidence_.resize(graph.links.size());
    for (const int k : held_) evidence_[static_cast<std::size_t>(k)] = evidence_of(k);
    rate_.emplace(graph.nodes, witnesses());
    for (const int k : held_) {
      TwinEvidence& said = evidence_[static_cast<std::size_t>(k)];
      said.otherwise_nats = std::min(said.otherwise_nats, kMostNats);
      said.alike_nats = std::min(said.alike_nats, kMostNats);
      witnesses_like_.push_back(views_.witnesses_like(k));
    }
    otherwise_ = search_over([&](int k) { return evidence(k).otherwise_nats; });
    alike_ = search_over([&](int k) { return evidence(k).alike_nats; });
    chance_ = search_over([&](int k) { return nats(k) + loop_nats(k); });
    if (accepted.heard.empty()) return;
    otherwise_heard_ =
        with_heard(otherwise_, [](const HeardPair& heard) { return heard.pair.evidence->otherwise_nats; });
    chance_heard_ = with_heard(chance_, [](const HeardPair& heard) { return heard.chance_nats; });
  }

  std::vector<NodeDoubt> run(const std::vector<int>& reference) {
    std::vector<NodeDoubt> doubts(static_cast<std::size_t>(graph_.nodes));
    for (CutSearch* search : {&otherwise_, &alike_, &chance_, &otherwise_heard_, &chance_heard_}) {
      if (!search->network) continue;
      for (const int root : reference) {
        if (root >= 0) search->held[static_cast<std::size_t>(root)] = true;
      }
    }
    const std::vector<int> order = outwards(reference);
    const auto is_held = [&](int node) {
      const int root = reference[static_cast<std::size_t>(node)];
      return root >= 0 && root != node;
    };
    Sides otherwise;
    Sides alike;
    for (const int node : order) {
      CancelScope::check();
      if (!is_held(node)) continue;
      add_sides(kTwinOtherwise, node, otherwise_, otherwise);
      if (otherwise_heard_.network) add_sides(kTwinOtherwise, node, otherwise_heard_, otherwise);
      add_sides(kTwinAlike, node, alike_, alike);
    }
    for (const int node : order) {
      const int root = reference[static_cast<std::size_t>(node)];
      NodeDoubt& doubt = doubts[static_cast<std::size_t>(node)];
      if (root == node) doubt.twin = doubt.chance = 0.0;
      if (!is_held(node)) continue;
      tell_twins(least_said(otherwise, node, root), least_said(alike, node, root), doubt);
      add_chance(node, doubt);
    }
    return doubts;
  }

  [[nodiscard]] NodeDoubt of_side(const std::vector<bool>& side) const {
    NodeDoubt doubt;
    tell_twins(across(kTwinOtherwise, side), across(kTwinAlike, side), doubt);
    tell_chance(side, doubt);
    return doubt;
  }

 private:
  [[nodiscard]] const GraphLink& link(int k) const { return graph_.links[static_cast<std::size_t>(k)]; }
  [[nodiscard]] double loop_nats(int k) const {
    return link(k).trust == LinkTrust::open ? kOpenLoopNats : kLoopNats;
  }
  /// Of the pose that was taken.
  [[nodiscard]] double nats(int k) const {
    const auto taken = static_cast<std::size_t>(accepted_.pose[static_cast<std::size_t>(k)]);
    const double other = link(k).trust == LinkTrust::open ? 1.0 - link(k).poses[taken].probability : 0.0;
    const double chance = std::max(link(k).chance, other);
    return chance > 0.0 ? std::clamp(-std::log(chance), 0.0, kMostNats) : kMostNats;
  }

  [[nodiscard]] std::vector<TwinWitness> witnesses() const {
    std::vector<TwinWitness> all;
    for (const int k : held_) {
      if (is_asked(k)) all.push_back({link(k).source, link(k).target, evidence(k)});
    }
    for (const GraphLink& pair : graph_.against) {
      if (pair.evidence) all.push_back({pair.source, pair.target, *pair.evidence});
    }
    return all;
  }

  /// Whether some pair shows two places that are built alike.
  [[nodiscard]] bool has_twins() const {
    return std::any_of(graph_.against.begin(), graph_.against.end(),
                       [](const GraphLink& pair) { return pair.evidence.has_value(); });
  }

  [[nodiscard]] bool is_asked(int k) const { return link(k).asks_for_twins(); }

  /// Of a pair whose things were not asked the other places are among its poses: what speaks against them
  /// speaks against twins.
  [[nodiscard]] TwinEvidence evidence_of(int k) const {
    if (is_asked(k)) return link(k).against_twins();
    TwinEvidence evidence;
    evidence.otherwise_nats = evidence.alike_nats = nats(k);
    return evidence;
  }

  /// Smallest cuts by one measure of what the links say. `held`: nodes between which and their reference
  /// enough is said across every cut, the references among them: no smaller cut parts them, so that a cut
  /// from all of them is that from the reference, found sooner.
  struct CutSearch {
    std::optional<FlowNetwork> network;
    std::vector<bool> held;
  };

  /// Links are worth `nats_of(link)`, shared with those that see the same.
  template <typename NatsOf>
  [[nodiscard]] CutSearch search_over(const NatsOf& nats_of) const {
    const auto nodes = static_cast<std::size_t>(graph_.nodes);
    CutSearch search{FlowNetwork(nodes), std::vector<bool>(nodes, false)};
    for (std::size_t i = 0; i < held_.size(); ++i) {
      const auto room =
          static_cast<int>(std::lround(kUnits * std::max(0.0, nats_of(held_[i]) / witnesses_like_[i])));
      search.network->connect(link(held_[i]).source, link(held_[i]).target, room, room);
    }
    return search;
  }

  /// The same with what pairs that hold nothing say for the solution.
  template <typename NatsOf>
  [[nodiscard]] CutSearch with_heard(const CutSearch& search, const NatsOf& nats_of) const {
    CutSearch more = search;
    for (const HeardPair& heard : accepted_.heard) {
      const auto room = static_cast<int>(std::lround(kUnits * std::max(0.0, nats_of(heard))));
      if (room > 0) more.network->connect(heard.pair.source, heard.pair.target, room, room);
    }
    return more;
  }

  /// All nodes, from the references outwards along the links that hold: a node's neighbours are mostly held
  /// when its own cut is sought.
  [[nodiscard]] std::vector<int> outwards(const std::vector<int>& reference) const {
    std::vector<std::vector<int>> beside(static_cast<std::size_t>(graph_.nodes));
    for (const int k : held_) {
      beside[static_cast<std::size_t>(link(k).source)].push_back(link(k).target);
      beside[static_cast<std::size_t>(link(k).target)].push_back(link(k).source);
    }
    std::vector<int> order;
    std::vector<bool> taken(beside.size(), false);
    const auto take = [&](int node) {
      if (taken[static_cast<std::size_t>(node)]) return;
      taken[static_cast<std::size_t>(node)] = true;
      order.push_back(node);
    };
    for (const int root : reference) {
      if (root >= 0) take(root);
    }
    for (std::size_t next = 0; next < order.size(); ++next) {
      for (const int node : beside[static_cast<std::size_t>(order[next])]) take(node);
    }
    for (int node = 0; node < graph_.nodes; ++node) take(node);
    return order;
  }

  struct Cut;
  static void tell_twins(const Cut& otherwise, const Cut& alike, NodeDoubt& doubt) {
    // Much may be said for a twin: against the largest of the three nothing overflows.
    const double none = 1.0 - otherwise.prior - alike.prior;
    const double most = std::max({otherwise.log_weight(), alike.log_weight(), std::log(none)});
    const double twin = std::exp(otherwise.log_weight() - most) + std::exp(alike.log_weight() - most);
    doubt.twin = twin / (twin + std::exp(std::log(none) - most));
    const Cut& likelier = otherwise.log_weight() > alike.log_weight() ? otherwise : alike;
    doubt.links = likelier.links;
    doubt.across = likelier.across;
    doubt.held_nats = likelier.held_nats;
  }

  struct Cut {
    double prior = 0.0;       ///< of a twin, by what was learned of the building
    double nats = 0.0;        ///< what things and walls say against it
    double held_nats = 0.0;   ///< of the former those only that do
    std::vector<int> links;   ///< that see different things
    std::vector<int> across;  ///< all
    /// Of the probability of a twin, against that of none.
    [[nodiscard]] double log_weight() const {
      return prior > 0.0 ? std::log(prior) - nats : -std::numeric_limits<double>::infinity();
    }
  };

  /// The side of `node` of the smallest cut between it and the reference; empty where enough is said across
  /// every one.
  static std::optional<std::vector<bool>> smallest_cut(CutSearch& search, int node) {
    std::optional<std::vector<bool>> side = search.network->smallest_cut(
        {node}, search.held, static_cast<int>(kUnits * (kEnoughNats + kLoopNats)));
    if (!side) search.held[static_cast<std::size_t>(node)] = true;
    return side;
  }

  /// Sides that may lie on a twin, and what is said across their cuts.
  using Sides = std::map<std::vector<bool>, Cut>;

  /// The node alone, and its side of the smallest cut between it and the reference.
  void add_sides(const TwinKind& kind, int node, CutSearch& search, Sides& sides) const {
    const auto add = [&](const std::vector<bool>& side) {
      if (sides.count(side) == 0) sides.emplace(side, across(kind, side));
    };
    std::vector<bool> alone(static_cast<std::size_t>(graph_.nodes), false);
    alone[static_cast<std::size_t>(node)] = true;
    add(alone);
    if (const std::optional<std::vector<bool>> side = smallest_cut(search, node)) add(*side);
  }

  /// Of all sides that hold the node and not the reference the one that is a twin most probably: where it is,
  /// the node stands wrongly, whichever node it was that the side was found for. (A network knows of what is
  /// said against a cut, not of what is said for it, so that a node's own smallest cut need not be that.)
  [[nodiscard]] static const Cut& least_said(const Sides& sides, int node, int reference) {
    const Cut* least = nullptr;
    for (const auto& [side, cut] : sides) {
      if (!side[static_cast<std::size_t>(node)] || side[static_cast<std::size_t>(reference)]) continue;
      if (least == nullptr || cut.log_weight() > least->log_weight()) least = &cut;
    }
    return *least;  // the node alone is one
  }

  /// What is said across a cut for and against a twin, by those first that say most.
  [[nodiscard]] Cut across(const TwinKind& kind, const std::vector<bool>& side) const {
    std::vector<TwinVoice> voices;
    for (const int k : crossing_links(side)) voices.push_back({&link(k), evidence(k), is_asked(k), k});
    for (const GraphLink* pair : against_) {
      if (side[static_cast<std::size_t>(pair->source)] != side[static_cast<std::size_t>(pair->target)])
        voices.push_back({pair, *pair->evidence});
    }
    for (const HeardPair& heard : accepted_.heard) {
      if (speaks_of(heard, side)) voices.push_back({&heard.pair, *heard.pair.evidence});
    }
    const TwinsAcross all = twins_across(views_, kind, std::move(voices), side);
    Cut cut{all.prior, all.nats + all.built_nats, all.held_nats, {}, {}};
    for (std::size_t i = 0; i < all.voices.size(); ++i) {
      const int link = all.voices[i].link;
      if (link < 0) continue;
      cut.across.push_back(link);
      if (all.fresh[i] > kHardlyFresh) cut.links.push_back(link);
    }
    const bool alike = kind.nats == kTwinAlike.nats;
    const TwinFactors learned = rate_->factors(side);
    // Rooms of another design teach nothing of how this one is furnished in its twins.
    const double least = alike && has_twins() ? std::min(cut.prior, kLeastAlike) : 0.0;
    cut.prior = std::clamp(cut.prior * (alike ? learned.alike : learned.otherwise), least, kMostBelieved);
    std::sort(cut.links.begin(), cut.links.end());
    return cut;
  }

  [[nodiscard]] const TwinEvidence& evidence(int k) const { return evidence_[static_cast<std::size_t>(k)]; }

  [[nodiscard]] std::vector<int> crossing_links(const std::vector<bool>& side) const {
    std::vector<int> crossing;
    for (const int k : held_) {
      if (side[static_cast<std::size_t>(link(k).source)] != side[static_cast<std::size_t>(link(k).target)])
        crossing.push_back(k);
    }
    return crossing;
  }

  void add_chance(int node, NodeDoubt& doubt) {
    const std::optional<std::vector<bool>> side = smallest_cut(chance_, node);
    doubt.chance = 0.0;
    if (!side) return;
    std::optional<std::vector<bool>> heard;
    if (chance_heard_.network) heard = smallest_cut(chance_heard_, node);
    if (!heard) return tell_chance(*side, doubt);
    NodeDoubt other = doubt;
    tell_chance(*heard, other);
    tell_chance(*side, doubt);
    if (other.chance > doubt.chance) doubt = other;
  }

  /// Whether a pair tells of a side that is asked for, and not of the rest.
  [[nodiscard]] static bool speaks_of(const HeardPair& heard, const std::vector<bool>& side) {
    return side[static_cast<std::size_t>(heard.pair.source)] &&
           !side[static_cast<std::size_t>(heard.pair.target)];
  }

  /// What pairs that hold nothing say across a cut against chance, as far as neither the links nor others of
  /// them have said it, those first that say most; and for it, all of them.
  [[nodiscard]] double heard_against_chance(const std::vector<bool>& side,
                                            const std::vector<int>& links) const {
    std::vector<const HeardPair*> voices;
    for (const HeardPair& heard : accepted_.heard) {
      if (speaks_of(heard, side)) voices.push_back(&heard);
    }
    std::stable_sort(voices.begin(), voices.end(),
                     [](const HeardPair* a, const HeardPair* b) { return a->chance_nats > b->chance_nats; });
    std::vector<const GraphLink*> told;
    for (const int k : links) told.push_back(&link(k));
    double against = 0.0;
    double speaks_for = 0.0;
    for (const HeardPair* heard : voices) {
      if (heard->chance_nats > 0.0)
        against += heard->chance_nats * (1.0 - views_.seen_already(heard->pair, told, side));
      else
        speaks_for += heard->chance_nats;
      told.push_back(&heard->pair);
    }
    return std::min(against, kMostHeardNats) + speaks_for;
  }

  /// What passes say of a node alone.
  [[nodiscard]] double heard_beyond(const std::vector<bool>& side) const {
    if (accepted_.beyond_nats.empty() || std::count(side.begin(), side.end(), true) != 1) return 0.0;
    return accepted_
        .beyond_nats[static_cast<std::size_t>(std::find(side.begin(), side.end(), true) - side.begin())];
  }

  void tell_chance(const std::vector<bool>& side, NodeDoubt& doubt) const {
    std::vector<int> crossing = crossing_links(side);
    std::stable_sort(crossing.begin(), crossing.end(), [&](int a, int b) { return nats(a) > nats(b); });
    const std::vector<int> chosen = views_.independent(crossing, side);
    double all = 0.0;
    double most = 0.0;  // the first link that holds closes no loop
    for (const int k : chosen) {
      all += nats(k) + loop_nats(k);
      most = std::max(most, loop_nats(k));
    }
    all += heard_against_chance(side, chosen) + heard_beyond(side) - most;
    doubt.chance = std::exp(-std::max(0.0, all));
    if (doubt.chance > doubt.twin) doubt.links = chosen;
  }

  const PoseGraph& graph_;
  const AcceptedPoses& accepted_;
  SharedViews views_;
  std::vector<int> held_;            ///< accepted links that hold
  std::vector<int> witnesses_like_;  ///< of each of them: how many links see what it sees
  std::vector<const GraphLink*>
      against_;                ///< of the pairs that speak for twins those that the solution lays so
  CutSearch otherwise_;        ///< by what is said against twins furnished otherwise
  CutSearch alike_;            ///< and alike
  CutSearch chance_;           ///< by how hardly links are wrong by chance
  CutSearch otherwise_heard_;  ///< the same with what pairs say that hold nothing; without a network: none do
  CutSearch chance_heard_;
  std::optional<TwinRate> rate_;
  std::vector<TwinEvidence> evidence_;  ///< of each link
};

}  // namespace

std::vector<NodeDoubt> doubts_of(const PoseGraph& graph, const AcceptedPoses& accepted,
                                 const std::vector<int>& reference, const DoubtOptions& options) {
  return DoubtSearch(graph, accepted, options).run(reference);
}

NodeDoubt doubt_of_side(const PoseGraph& graph, const AcceptedPoses& accepted,
                        const std::vector<bool>& side) {
  return DoubtSearch(graph, accepted, {}).of_side(side);
}

}  // namespace limen
