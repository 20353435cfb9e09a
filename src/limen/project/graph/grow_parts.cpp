// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/grow_parts.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <map>
#include <set>
#include <unordered_map>
#include <utility>

#include "limen/base/progress.h"

namespace limen {
namespace {

// Poses within a part are not adjusted yet: what links miss one another by is judged more mildly.
constexpr double kMild = 4.0;
constexpr double kMostJoinNats = 14.0;  // no link is surer than about one in a million
constexpr double kNearM = 2.0;    // poses further apart than this are not one, whatever is known of them ...
constexpr double kNearRad = 0.3;  // ... nor turned by more
constexpr double kGivenNats = 100.0;   // of what a file says
constexpr double kJoinLoopNats = 7.0;  // sure links that are wrong close a loop once in a thousand
constexpr int kMostLoops = 3;          // of a link that count: they share their errors
constexpr double kSureNats = 6.9;      // of a join of open links that is as sure as one of a sure link: 0.001
constexpr double kEnoughM2 = 20.0;     // more surface than this makes a link no surer ...
constexpr double kSurfaceNats = 0.5;   // ... and less only decides between what is as sure

/// One pose of a link between two parts, from the lower to the higher part.
struct Crossing {
  std::size_t link = 0;
  std::size_t pose = 0;
  LinkPose between;  ///< target: a node of the higher part
  int lower_node = -1;
  int higher_node = -1;
  Rigid3 higher_from_lower;                 ///< frames of the parts
  Vector3d meets_lower = Vector3d::Zero();  ///< where it is known best, in either part
  Vector3d meets_higher = Vector3d::Zero();
  double nats = 0.0;  ///< how much more probable the pose is than that none of its link's is right
};

/// What leads from one part to another. Parts are rigid: which of their crossings agree is asked once.
struct Passage {
  std::vector<std::size_t> links;
  std::vector<std::vector<std::size_t>>
      agreeing;                     ///< of each crossing, their poses in turn: those that agree
  std::vector<std::size_t> blocks;  ///< so many crossings after one another have been held against each other
};

/// A way to join two parts.
struct Join {
  JoinTrust trust = JoinTrust::weak;
  double lead = -1.0;  ///< logarithm of the odds against every other way, and against none
  double most = 0.0;   ///< what is said for it, whatever is said for others
  Rigid3 higher_from_lower;
  bool valid = false;
  bool known = true;  ///< otherwise `lead` and `most` are what they are at the most, and no more is known

  /// Weak links last: they leave a direction free.
  [[nodiscard]] bool before(const Join& other) const {
    const bool weak = known && trust == JoinTrust::weak;
    const bool weak_other = other.known && other.trust == JoinTrust::weak;
    return weak != weak_other ? weak_other : lead > other.lead;
  }
};

/// Of two sets of crossings between the same parts, what their union leads by at most: what is best by both
/// gains what the others say for it, and that they agree. (Where ways agree in part it may be more; then the
/// parts are asked later than they might be.)
Join join_of_both(const Join& a, const Join& b) {
  Join both = a.valid ? a : b;
  both.known = false;
  if (!a.valid || !b.valid) return both;
  both.most = a.most + b.most + kJoinLoopNats;
  both.lead = std::min(std::max(a.lead, 0.0) + b.most, std::max(b.lead, 0.0) + a.most) + kJoinLoopNats;
  return both;
}

class Grower {
 public:
  Grower(const PoseGraph& graph, const std::vector<std::vector<int>>& votes,
         const std::vector<bool>& left_out)
      : graph_(graph), votes_(votes) {
    const auto nodes = static_cast<std::size_t>(graph.nodes);
    grown_.part_from_node.resize(nodes);
    for (int node = 0; node < graph.nodes; ++node) {
      grown_.part.push_back(node);
      members_.push_back({node});
    }
    neighbours_.resize(nodes);
    for (std::size_t k = 0; k < graph.links.size() + graph.against.size(); ++k) {
      if (holds(k) && left_out[k]) continue;
      const GraphLink& link = pair(k);
      Passage& passage = between_[key(link.source, link.target)];
      passage.links.push_back(k);
      passage.blocks.push_back(poses_of(k));
      passage.agreeing.resize(passage.agreeing.size() + poses_of(k));
      double& shared = shared_m2_[number_of(link.source, link.target)];
      shared = std::max(shared, link.poses.front().agreeing_m2);
      neighbours_[static_cast<std::size_t>(link.source)].insert(link.target);
      neighbours_[static_cast<std::size_t>(link.target)].insert(link.source);
    }
  }

  GrownParts run() {
    for (const auto& [parts, passage] : between_) joins_[parts] = best_join(parts);
    while (step()) CancelScope::check();
    return std::move(grown_);
  }

 private:
  /// Pairs by number: the links, then what speaks against.
  [[nodiscard]] bool holds(std::size_t k) const { return k < graph_.links.size(); }
  [[nodiscard]] const GraphLink& pair(std::size_t k) const {
    return holds(k) ? graph_.links[k] : graph_.against[k - graph_.links.size()];
  }

  /// How many of them count: of what speaks against, the best.
  [[nodiscard]] std::size_t poses_of(std::size_t k) const { return holds(k) ? pair(k).poses.size() : 1; }

  using Parts = std::pair<int, int>;
  static Parts key(int a, int b) { return {std::min(a, b), std::max(a, b)}; }
  static std::uint64_t number_of(int a, int b) {
    return std::uint64_t{static_cast<std::uint32_t>(std::min(a, b))} << 32 |
           static_cast<std::uint32_t>(std::max(a, b));
  }

  /// Joins the two parts for which most is said; false: there are none. Of those that changed it is asked
  /// only where they may come first.
  bool step() {
    for (;;) {
      Join* best = nullptr;
      Parts parts;
      for (auto& [pair, join] : joins_) {
        if (!join.valid) continue;
        // Of equals one of which less is known comes first: it may fall behind.
        const bool same = best != nullptr && !join.before(*best) && !best->before(join);
        if (best != nullptr && !join.before(*best) && !(same && best->known && !join.known)) continue;
        best = &join;
        parts = pair;
      }
      if (best == nullptr) return false;
      if (best->known) {
        join(parts, Join(*best));
        return true;
      }
      *best = best_join(parts);
    }
  }

  void join(Parts parts, const Join& how) {
    const auto [lower, higher] = parts;
    const Rigid3 lower_from_higher = inverse(how.higher_from_lower);
    const std::vector<int>& low = members_[static_cast<std::size_t>(lower)];
    const std::vector<int>& high = members_[static_cast<std::size_t>(higher)];
    if (how.trust > JoinTrust::sure)
      grown_.joins.push_back({low.size() < high.size() ? low : high, how.trust});
    for (const int node : members_[static_cast<std::size_t>(higher)]) {
      const auto n = static_cast<std::size_t>(node);
      grown_.part[n] = lower;
      grown_.part_from_node[n] = lower_from_higher * grown_.part_from_node[n];
      members_[static_cast<std::size_t>(lower)].push_back(node);
    }
    members_[static_cast<std::size_t>(higher)].clear();
    joins_.erase(parts);
    between_.erase(parts);
    std::set<int>& own = neighbours_[static_cast<std::size_t>(lower)];
    own.erase(higher);
    for (const int other : neighbours_[static_cast<std::size_t>(higher)]) {
      if (other == lower) continue;
      take_over(key(higher, other), key(lower, other));
      neighbours_[static_cast<std::size_t>(other)].erase(higher);
      neighbours_[static_cast<std::size_t>(other)].insert(lower);
      own.insert(other);
    }
    neighbours_[static_cast<std::size_t>(higher)].clear();
  }

  /// What joins two parts once one of them has become part of another.
  void take_over(const Parts& from, const Parts& to) {
    Passage& passage = between_[to];
    Passage& more = between_[from];
    for (std::vector<std::size_t>& agreeing : more.agreeing) {
      for (std::size_t& other : agreeing) other += passage.agreeing.size();
    }
    passage.links.insert(passage.links.end(), more.links.begin(), more.links.end());
    passage.blocks.insert(passage.blocks.end(), more.blocks.begin(), more.blocks.end());
    passage.agreeing.insert(passage.agreeing.end(), std::make_move_iterator(more.agreeing.begin()),
                            std::make_move_iterator(more.agreeing.end()));
    joins_[to] = join_of_both(joins_[to], joins_[from]);
    between_.erase(from);
    joins_.erase(from);
  }

  [[nodiscard]] std::vector<Crossing> crossings(const Parts& parts) const {
    std::vector<Crossing> list;
    for (const std::size_t k : between_.at(parts).links) {
      const GraphLink& link = pair(k);
      const bool forward = grown_.part[static_cast<std::size_t>(link.source)] == parts.first;
      for (std::size_t p = 0; p < poses_of(k); ++p) {
        Crossing c;
        c.link = k;
        c.pose = p;
        c.between = forward ? link.poses[p] : reversed(link.poses[p]);
        c.lower_node = forward ? link.source : link.target;
        c.higher_node = forward ? link.target : link.source;
        c.higher_from_lower =
            part_from(c.higher_node) * c.between.target_from_source * inverse(part_from(c.lower_node));
        c.meets_higher = part_from(c.higher_node) * c.between.centre;
        c.meets_lower = inverse(c.higher_from_lower) * c.meets_higher;
        c.nats = nats_of(k, p);
        list.push_back(c);
      }
    }
    return list;
  }

  [[nodiscard]] const Rigid3& part_from(int node) const {
    return grown_.part_from_node[static_cast<std::size_t>(node)];
  }

  /// Whether two crossings put the parts together alike.
  [[nodiscard]] bool agree(const Crossing& a, const Crossing& b) const {
    if ((a.higher_from_lower * b.meets_lower - b.meets_higher).squaredNorm() > kNearM * kNearM) return false;
    const Rigid3 target_from_part = inverse(part_from(b.higher_node));
    const Rigid3 predicted = target_from_part * a.higher_from_lower * part_from(b.lower_node);
    const Vector6d missed = misfit(b.between, predicted);
    if (missed.head<3>().squaredNorm() > kNearRad * kNearRad) return false;
    const Matrix6d covariance =
        b.between.covariance +
        moved_covariance(a.between, target_from_part * part_from(a.higher_node), b.between.centre);
    // The whole is no less than the shift alone, along the axis that is known least.
    if (missed.tail<3>().squaredNorm() > kMild * kChiSquareBound * covariance.diagonal().tail<3>().sum())
      return false;
    return chi_square(missed, kMild * covariance) <= kChiSquareBound;
  }

  /// What a pose of a pair says, with the loops that it closes; of a pair that speaks against, its odds.
  [[nodiscard]] double nats_of(std::size_t k, std::size_t pose) const {
    const GraphLink& link = pair(k);
    if (link.trust == LinkTrust::given) return kGivenNats;
    if (!holds(k)) {
      const double wrong =
          std::clamp(link.chance + link.twin, std::exp(-kMostJoinNats), 1.0 - std::exp(-kMostJoinNats));
      return std::log((1.0 - wrong) / wrong);
    }
    const double surface = std::min(link.poses[pose].agreeing_m2, kEnoughM2) / kEnoughM2;
    return nats_for(link, pose, kMostJoinNats) + kJoinLoopNats * std::min(votes_[k][pose], kMostLoops) +
           kSurfaceNats * surface;
  }

  /// What it adds to what another has said: that there is a twin is believed of the place, once.
  [[nodiscard]] double more_nats_of(const Crossing& c) const {
    const GraphLink& link = pair(c.link);
    if (!link.evidence) return c.nats;
    return std::min({link.evidence->otherwise_nats, link.evidence->alike_nats, c.nats});
  }

  /// How much of what a crossing shows another shows as well: scans of one room say nearly the same.
  [[nodiscard]] double seen_by(const Crossing& c, const Crossing& other) const {
    const double surface = pair(c.link).poses[c.pose].agreeing_m2;
    const auto share = [&](int a, int b) {
      if (a == b || surface <= 0.0) return 1.0;
      const auto found = shared_m2_.find(number_of(a, b));
      return found == shared_m2_.end() ? 0.0 : std::min(1.0, found->second / surface);
    };
    return share(c.lower_node, other.lower_node) * share(c.higher_node, other.higher_node);
  }

  /// What crossings that agree say together; of each link the pose that says most.
  [[nodiscard]] double nats_of_all(std::vector<const Crossing*> agreeing) const {
    std::stable_sort(agreeing.begin(), agreeing.end(),
                     [&](const Crossing* a, const Crossing* b) { return a->nats > b->nats; });
    std::set<std::size_t> links;
    std::vector<const Crossing*> heard;
    double sum = 0.0;
    for (const Crossing* c : agreeing) {
      if (!links.insert(c->link).second) continue;
      double seen = 0.0;
      for (const Crossing* other : heard) {
        if (seen >= 1.0) break;
        if (holds(c->link) == holds(other->link)) seen = std::max(seen, seen_by(*c, *other));
      }
      sum += (1.0 - seen) * (heard.empty() ? c->nats : more_nats_of(*c));
      // Sure poses that are wrong agree by chance only, whatever they see.
      if (!heard.empty() && holds(c->link) && pair(c->link).trust <= LinkTrust::sure) sum += kJoinLoopNats;
      heard.push_back(c);
    }
    return sum;
  }

  [[nodiscard]] JoinTrust trust_of(const std::vector<const Crossing*>& agreeing, double lead) const {
    LinkTrust surest = LinkTrust::weak;
    for (const Crossing* c : agreeing) {
      if (holds(c->link)) surest = std::min(surest, pair(c->link).trust);
    }
    if (surest == LinkTrust::weak) return JoinTrust::weak;
    if (surest <= LinkTrust::sure || lead >= kSureNats) return JoinTrust::sure;
    return surest == LinkTrust::likely ? JoinTrust::likely : JoinTrust::open;
  }

  /// What speaks for one way: a crossing, and all that agree with it.
  struct Way {
    const Crossing* middle = nullptr;
    std::vector<const Crossing*> agreeing;
    double at_most = 0.0;  ///< what they would say together if none showed what another shows
    double nats = 0.0;
  };

  /// Holds crossings against each other that have not been.
  void compare(const std::vector<Crossing>& all, Passage& passage) const {
    const auto ask = [&](std::size_t i, std::size_t j) {
      if (holds(all[i].link) && agree(all[i], all[j])) passage.agreeing[i].push_back(j);
    };
    std::size_t first = 0;
    for (const std::size_t count : passage.blocks) {
      for (std::size_t i = 0; i < first; ++i) {
        for (std::size_t j = first; j < first + count; ++j) {
          ask(i, j);
          ask(j, i);
        }
      }
      first += count;
    }
    passage.blocks = {first};
    for (std::vector<std::size_t>& agreeing : passage.agreeing) std::sort(agreeing.begin(), agreeing.end());
  }

  /// A way about each crossing; one that only speaks against is none.
  [[nodiscard]] std::vector<Way> ways_of(const std::vector<Crossing>& all, const Passage& passage) const {
    std::vector<Way> ways(all.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (!holds(all[i].link)) continue;
      ways[i].middle = &all[i];
      ways[i].agreeing.push_back(&all[i]);
      for (const std::size_t other : passage.agreeing[i]) ways[i].agreeing.push_back(&all[other]);
      for (const Crossing* c : ways[i].agreeing) ways[i].at_most += std::max(c->nats, 0.0);
    }
    return ways;
  }

  /// Of what agrees the pose with the least deviation: nothing is adjusted until all parts stand.
  [[nodiscard]] const Crossing& best_known(const Way& way) const {
    const Crossing* best = way.middle;
    const auto variance = [](const Crossing* c) { return c->between.covariance.diagonal().tail<3>().sum(); };
    for (const Crossing* c : way.agreeing) {
      if (holds(c->link) && variance(c) < variance(best)) best = c;
    }
    return *best;
  }

  /// The way that most is said for, by how much it leads before every other. Crossings that agree are one
  /// way, about the one that agrees with most: each way is weighed once.
  [[nodiscard]] Join best_join(const Parts& parts) {
    const std::vector<Crossing> all = crossings(parts);
    Passage& passage = between_.at(parts);
    compare(all, passage);
    std::vector<Way> ways = ways_of(all, passage);
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (holds(all[i].link)) order.push_back(i);
    }
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return ways[a].at_most > ways[b].at_most; });
    Join best;
    const Way* most = nullptr;
    std::vector<const Way*> weighed;
    std::vector<bool> same(all.size(), false);
    for (const std::size_t i : order) {
      if (same[i]) continue;
      ways[i].nats = nats_of_all(ways[i].agreeing);
      for (const Crossing* c : ways[i].agreeing) same[static_cast<std::size_t>(c - all.data())] = true;
      weighed.push_back(&ways[i]);
      if (most != nullptr && ways[i].nats <= most->nats) continue;
      most = &ways[i];
    }
    if (most == nullptr) return best;
    double second = 0.0;
    for (const Way* way : weighed) {
      const bool agrees =
          std::find(most->agreeing.begin(), most->agreeing.end(), way->middle) != most->agreeing.end();
      if (!agrees) second = std::max(second, way->nats);
    }
    best.higher_from_lower = best_known(*most).higher_from_lower;
    best.most = most->nats;
    best.lead = most->nats - second;
    best.trust = trust_of(most->agreeing, best.lead);
    best.valid = true;
    return best;
  }

  const PoseGraph& graph_;
  const std::vector<std::vector<int>>& votes_;
  GrownParts grown_;
  std::vector<std::vector<int>> members_;
  std::vector<std::set<int>> neighbours_;
  std::map<Parts, Passage> between_;
  std::unordered_map<std::uint64_t, double> shared_m2_;  ///< surface that two nodes show in common
  std::map<Parts, Join> joins_;
};

}  // namespace

std::vector<JoinTrust> GrownParts::trust_from(int reference) const {
  std::vector<JoinTrust> trust(part.size(), JoinTrust::sure);
  for (const GrownJoin& join : joins) {
    std::vector<bool> within(part.size(), false);
    for (const int node : join.smaller) within[static_cast<std::size_t>(node)] = true;
    const bool from_smaller = reference >= 0 && within[static_cast<std::size_t>(reference)];
    const int home = part[static_cast<std::size_t>(join.smaller.front())];
    for (std::size_t node = 0; node < part.size(); ++node) {
      if (within[node] != from_smaller && part[node] == home) trust[node] = std::max(trust[node], join.trust);
    }
  }
  return trust;
}

GrownParts grow_parts(const PoseGraph& graph, const std::vector<std::vector<int>>& votes,
                      const std::vector<bool>& left_out) {
  return Grower(graph, votes, left_out).run();
}

}  // namespace limen
