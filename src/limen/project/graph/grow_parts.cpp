// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/grow_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "limen/base/progress.h"

namespace limen {
namespace {

// Poses within a part are not adjusted yet: what links miss one another by is judged more mildly.
constexpr double kMild = 4.0;
constexpr double kMostJoinNats = 14.0;  // no link is surer than about one in a million
constexpr double kLeastRight = 1e-9;
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
  Rigid3 higher_from_lower;  ///< frames of the parts
};

/// A way to join two parts.
struct Join {
  JoinTrust trust = JoinTrust::weak;
  double lead = -1.0;  ///< logarithm of the odds against every other way, and against none
  Rigid3 higher_from_lower;
  bool valid = false;

  /// Weak links last: they leave a direction free.
  [[nodiscard]] bool before(const Join& other) const {
    const bool weak = trust == JoinTrust::weak;
    const bool weak_other = other.trust == JoinTrust::weak;
    return weak != weak_other ? weak_other : lead > other.lead;
  }
};

class Grower {
 public:
  Grower(const PoseGraph& graph, const std::vector<std::vector<int>>& votes,
         const std::vector<bool>& left_out)
      : graph_(graph), votes_(votes) {
    const auto nodes = static_cast<std::size_t>(graph.nodes);
    grown_.part_from_node.resize(nodes);
    grown_.trust.assign(nodes, JoinTrust::sure);
    for (int node = 0; node < graph.nodes; ++node) {
      grown_.part.push_back(node);
      members_.push_back({node});
    }
    neighbours_.resize(nodes);
    for (std::size_t k = 0; k < graph.links.size() + graph.against.size(); ++k) {
      if (holds(k) && left_out[k]) continue;
      const GraphLink& link = pair(k);
      between_[key(link.source, link.target)].push_back(k);
      double& shared = shared_m2_[key(link.source, link.target)];
      shared = std::max(shared, link.poses.front().agreeing_m2);
      neighbours_[static_cast<std::size_t>(link.source)].insert(link.target);
      neighbours_[static_cast<std::size_t>(link.target)].insert(link.source);
    }
  }

  GrownParts run() {
    for (const auto& [parts, links] : between_) joins_[parts] = best_join(parts);
    while (step()) CancelScope::check();
    return std::move(grown_);
  }

 private:
  /// Pairs by number: the links, then what speaks against.
  [[nodiscard]] bool holds(std::size_t k) const { return k < graph_.links.size(); }
  [[nodiscard]] const GraphLink& pair(std::size_t k) const {
    return holds(k) ? graph_.links[k] : graph_.against[k - graph_.links.size()];
  }

  using Parts = std::pair<int, int>;
  static Parts key(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

  bool step() {
    const Join* best = nullptr;
    Parts parts;
    for (const auto& [pair, join] : joins_) {
      if (!join.valid) continue;
      if (best != nullptr && !join.before(*best)) continue;
      best = &join;
      parts = pair;
    }
    if (best == nullptr) return false;
    join(parts, Join(*best));
    return true;
  }

  void join(Parts parts, const Join& how) {
    const auto [lower, higher] = parts;
    const Rigid3 lower_from_higher = inverse(how.higher_from_lower);
    const std::vector<int>& low = members_[static_cast<std::size_t>(lower)];
    const std::vector<int>& high = members_[static_cast<std::size_t>(higher)];
    for (const int node : low.size() < high.size() ? low : high) {
      JoinTrust& trust = grown_.trust[static_cast<std::size_t>(node)];
      trust = std::max(trust, how.trust);
    }
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
      std::vector<std::size_t>& links = between_[key(lower, other)];
      const std::vector<std::size_t>& more = between_[key(higher, other)];
      links.insert(links.end(), more.begin(), more.end());
      between_.erase(key(higher, other));
      joins_.erase(key(higher, other));
      neighbours_[static_cast<std::size_t>(other)].erase(higher);
      neighbours_[static_cast<std::size_t>(other)].insert(lower);
      own.insert(other);
      joins_[key(lower, other)] = best_join(key(lower, other));
    }
    neighbours_[static_cast<std::size_t>(higher)].clear();
  }

  [[nodiscard]] std::vector<Crossing> crossings(const Parts& parts) const {
    std::vector<Crossing> list;
    for (const std::size_t k : between_.at(parts)) {
      const GraphLink& link = pair(k);
      const bool forward = grown_.part[static_cast<std::size_t>(link.source)] == parts.first;
      for (std::size_t p = 0; p < (holds(k) ? link.poses.size() : 1); ++p) {
        Crossing c;
        c.link = k;
        c.pose = p;
        c.between = forward ? link.poses[p] : reversed(link.poses[p]);
        c.lower_node = forward ? link.source : link.target;
        c.higher_node = forward ? link.target : link.source;
        c.higher_from_lower =
            part_from(c.higher_node) * c.between.target_from_source * inverse(part_from(c.lower_node));
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
    const Rigid3 target_from_part = inverse(part_from(b.higher_node));
    const Rigid3 predicted = target_from_part * a.higher_from_lower * part_from(b.lower_node);
    const Vector6d missed = misfit(b.between, predicted);
    if (missed.tail<3>().squaredNorm() > 4.0 || missed.head<3>().squaredNorm() > 0.1) return false;
    const Matrix6d covariance =
        b.between.covariance +
        moved_covariance(a.between, target_from_part * part_from(a.higher_node), b.between.centre);
    return chi_square(missed, kMild * covariance) <= kChiSquareBound;
  }

  /// Logarithm of how much more probable a pose of a pair is than that none of its poses is right.
  [[nodiscard]] double nats_of(const Crossing& c) const {
    const GraphLink& link = pair(c.link);
    if (link.trust == LinkTrust::given) return kGivenNats;
    const double wrong =
        std::clamp(link.chance + link.twin, std::exp(-kMostJoinNats), 1.0 - std::exp(-kMostJoinNats));
    if (!holds(c.link)) return std::log((1.0 - wrong) / wrong);
    const bool best = c.pose == 0 && link.trust <= LinkTrust::likely;
    const double right = best ? 1.0 - wrong : link.poses[c.pose].probability;
    const double own = std::clamp(std::log(std::max(right, kLeastRight) / wrong), 0.0, kMostJoinNats);
    const double surface = std::min(link.poses[c.pose].agreeing_m2, kEnoughM2) / kEnoughM2;
    return own + kJoinLoopNats * std::min(votes_[c.link][c.pose], kMostLoops) + kSurfaceNats * surface;
  }

  /// What it adds to what another has said: that there is a twin is believed of the place, once.
  [[nodiscard]] double more_nats_of(const Crossing& c) const {
    const GraphLink& link = pair(c.link);
    if (!link.evidence) return nats_of(c);
    return std::min({link.evidence->otherwise_nats, link.evidence->alike_nats, nats_of(c)});
  }

  /// How much of what a crossing shows another shows as well: scans of one room say nearly the same.
  [[nodiscard]] double seen_by(const Crossing& c, const Crossing& other) const {
    const double surface = pair(c.link).poses[c.pose].agreeing_m2;
    const auto share = [&](int a, int b) {
      if (a == b || surface <= 0.0) return 1.0;
      const auto found = shared_m2_.find(key(a, b));
      return found == shared_m2_.end() ? 0.0 : std::min(1.0, found->second / surface);
    };
    return share(c.lower_node, other.lower_node) * share(c.higher_node, other.higher_node);
  }

  /// What crossings that agree say together; of each link the pose that says most.
  [[nodiscard]] double nats_of(std::vector<const Crossing*> agreeing) const {
    std::stable_sort(agreeing.begin(), agreeing.end(),
                     [&](const Crossing* a, const Crossing* b) { return nats_of(*a) > nats_of(*b); });
    std::set<std::size_t> links;
    std::vector<const Crossing*> heard;
    double sum = 0.0;
    for (const Crossing* c : agreeing) {
      if (!links.insert(c->link).second) continue;
      double seen = 0.0;
      for (const Crossing* other : heard) {
        if (holds(c->link) == holds(other->link)) seen = std::max(seen, seen_by(*c, *other));
      }
      sum += (1.0 - seen) * (heard.empty() ? nats_of(*c) : more_nats_of(*c));
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

  /// The way that most is said for, by how much it leads before every other.
  [[nodiscard]] Join best_join(const Parts& parts) const {
    const std::vector<Crossing> all = crossings(parts);
    std::vector<std::vector<const Crossing*>> agreeing(all.size());
    std::vector<double> nats;
    for (std::size_t i = 0; i < all.size(); ++i) {
      for (const Crossing& other : all) {
        if (&other == &all[i] || (other.link != all[i].link && agree(all[i], other)))
          agreeing[i].push_back(&other);
      }
      nats.push_back(holds(all[i].link) ? nats_of(agreeing[i]) : -std::numeric_limits<double>::infinity());
    }
    Join best;
    const bool none = std::none_of(all.begin(), all.end(), [&](const Crossing& c) { return holds(c.link); });
    if (none) return best;
    const auto most = static_cast<std::size_t>(std::max_element(nats.begin(), nats.end()) - nats.begin());
    double second = 0.0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const bool same =
          std::find(agreeing[most].begin(), agreeing[most].end(), &all[i]) != agreeing[most].end();
      if (!same) second = std::max(second, nats[i]);
    }
    best.higher_from_lower = all[most].higher_from_lower;
    best.lead = nats[most] - second;
    best.trust = trust_of(agreeing[most], best.lead);
    best.valid = true;
    return best;
  }

  const PoseGraph& graph_;
  const std::vector<std::vector<int>>& votes_;
  GrownParts grown_;
  std::vector<std::vector<int>> members_;
  std::vector<std::set<int>> neighbours_;
  std::map<Parts, std::vector<std::size_t>> between_;
  std::map<Parts, double> shared_m2_;  ///< surface that two nodes show in common
  std::map<Parts, Join> joins_;
};

}  // namespace

GrownParts grow_parts(const PoseGraph& graph, const std::vector<std::vector<int>>& votes,
                      const std::vector<bool>& left_out) {
  return Grower(graph, votes, left_out).run();
}

}  // namespace limen
