// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/grow_parts.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "limen/base/progress.h"

namespace limen {
namespace {

// Poses within a part are not adjusted yet: what links miss one another by is judged more mildly.
constexpr double kMild = 4.0;
constexpr double kEnoughM2 = 20.0;  // more surface than this makes a link no surer

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
  double evidence = -1.0;
  Rigid3 higher_from_lower;
  bool valid = false;
};

class Grower {
 public:
  Grower(const PoseGraph& graph, const std::vector<std::vector<int>>& votes) : graph_(graph), votes_(votes) {
    const auto nodes = static_cast<std::size_t>(graph.nodes);
    grown_.part_from_node.resize(nodes);
    grown_.trust.assign(nodes, JoinTrust::sure);
    for (int node = 0; node < graph.nodes; ++node) {
      grown_.part.push_back(node);
      members_.push_back({node});
    }
    neighbours_.resize(nodes);
    for (std::size_t k = 0; k < graph.links.size(); ++k) {
      const GraphLink& link = graph.links[k];
      between_[key(link.source, link.target)].push_back(k);
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
  using Parts = std::pair<int, int>;
  static Parts key(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

  bool step() {
    const Join* best = nullptr;
    Parts parts;
    for (const auto& [pair, join] : joins_) {
      if (!join.valid) continue;
      if (best != nullptr &&
          (join.trust > best->trust || (join.trust == best->trust && join.evidence <= best->evidence)))
        continue;
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
      const GraphLink& link = graph_.links[k];
      const bool forward = grown_.part[static_cast<std::size_t>(link.source)] == parts.first;
      for (std::size_t p = 0; p < link.poses.size(); ++p) {
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

  [[nodiscard]] double value_of(const Crossing& c) const {
    const GraphLink& link = graph_.links[c.link];
    const double surface = std::min(link.poses[c.pose].agreeing_m2, kEnoughM2) / kEnoughM2;
    const double own = link.trust == LinkTrust::given    ? 100.0
                       : link.trust == LinkTrust::sure   ? 1.0
                       : link.trust == LinkTrust::likely ? 0.6
                                                         : 0.3;
    return own + votes_[c.link][c.pose] + 0.5 * surface;
  }

  /// Of a join that no sure link bears; `several`: links agree on it, and a loop of one of them closes.
  [[nodiscard]] static JoinTrust lesser_trust(LinkTrust candidate, bool several) {
    if (candidate == LinkTrust::weak) return JoinTrust::weak;
    if (candidate == LinkTrust::likely) return JoinTrust::likely;
    return several ? JoinTrust::sure : JoinTrust::open;
  }

  /// The joint pose of most evidence: the links that agree with a crossing speak for it, sure ones that do
  /// not speak against it.
  [[nodiscard]] Join best_join(const Parts& parts) const {
    const std::vector<Crossing> all = crossings(parts);
    Join best;
    for (const Crossing& candidate : all) {
      Join join;
      join.higher_from_lower = candidate.higher_from_lower;
      join.valid = true;
      std::map<std::size_t, double> value;  // of each link: its best agreeing pose
      std::set<std::size_t> against;
      int firm = 0;
      for (const Crossing& other : all) {
        const GraphLink& link = graph_.links[other.link];
        const bool agrees = (other.link == candidate.link && other.pose == candidate.pose) ||
                            (other.link != candidate.link && agree(candidate, other));
        if (agrees) {
          value[other.link] = std::max(value[other.link], value_of(other));
          if (link.trust <= LinkTrust::sure) join.trust = JoinTrust::sure;
          if (votes_[other.link][other.pose] > 0) ++firm;
        } else if (link.trust <= LinkTrust::sure) {
          against.insert(other.link);
        }
      }
      join.evidence = 0.0;
      for (const auto& [link, worth] : value) join.evidence += worth;
      for (const std::size_t link : against) join.evidence -= value.count(link) > 0 ? 0.0 : 0.5;
      if (join.trust != JoinTrust::sure)
        join.trust = lesser_trust(graph_.links[candidate.link].trust, firm >= 1 && value.size() >= 2);
      const bool better = !best.valid || join.trust < best.trust ||
                          (join.trust == best.trust && join.evidence > best.evidence);
      if (better) best = join;
    }
    return best;
  }

  const PoseGraph& graph_;
  const std::vector<std::vector<int>>& votes_;
  GrownParts grown_;
  std::vector<std::vector<int>> members_;
  std::vector<std::set<int>> neighbours_;
  std::map<Parts, std::vector<std::size_t>> between_;
  std::map<Parts, Join> joins_;
};

}  // namespace

GrownParts grow_parts(const PoseGraph& graph, const std::vector<std::vector<int>>& votes) {
  return Grower(graph, votes).run();
}

}  // namespace limen
