// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/configuration.h"

#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "limen/base/disjoint_sets.h"
#include "limen/base/progress.h"
#include "limen/geometry/linear.h"
#include "limen/project/graph/moves.h"
#include "limen/project/graph/pose_adjustment.h"

namespace limen {
namespace {

constexpr double kWideGate = 16.0;          // times the bound, while errors of chains are not spread yet
constexpr std::size_t kMostProposals = 48;  // of placements of two parts
constexpr int kMostMoves = 200;             // of scans and parts, one after the other
constexpr double kLeastGain = 1e-6;         // nats
constexpr double kLeastOdds = 1e-300;
// Look-alike places in a building of twenty scans that show none, against what is believed beforehand
// (LookAlikeRate): what may yet be learned of a building joins its parts, and PlacementOdds parts them.
constexpr double kLeastRate = 0.04;
constexpr int kMostReopened = 3;

/// The placement of two parts that the pairs between them say most for.
struct PartJoin {
  double nats = 0.0;
  double lead = 0.0;  ///< over the next different placement, or over none
  Rigid3 first_from_second;
};

/// Parts grow by joining the two whose placement is clearest.
class Growth {
 public:
  Growth(const PoseGraph& graph, const LinkMatcher& matcher, Configuration& grown)
      : graph_(graph), matcher_(matcher), grown_(grown) {}

  void run() {
    for (const bool weak : {false, true}) {
      weak_ = weak;
      collect();
      for (;;) {
        CancelScope::check();
        const auto best = std::max_element(joins_.begin(), joins_.end(), [](const auto& a, const auto& b) {
          return std::tuple(a.second.lead, a.second.nats) < std::tuple(b.second.lead, b.second.nats);
        });
        if (best == joins_.end()) break;
        join(best->first, best->second);
      }
    }
  }

 private:
  using Parts = std::pair<int, int>;  ///< the lower one first

  [[nodiscard]] int part(int node) const { return grown_.component[static_cast<std::size_t>(node)]; }
  [[nodiscard]] const Rigid3& at(int node) const {
    return grown_.frame_from_node[static_cast<std::size_t>(node)];
  }

  void collect() {
    links_.clear();
    joins_.clear();
    for (std::size_t k = 0; k < graph_.links.size(); ++k) add(k);
    for (const auto& [parts, links] : links_) find_join(parts);
  }

  void add(std::size_t k) {
    const Parts parts = std::minmax(part(graph_.links[k].source), part(graph_.links[k].target));
    if (parts.first != parts.second) links_[parts].push_back(k);
  }

  /// Where the first part has the second, by a pose of a link between them.
  [[nodiscard]] Rigid3 placement(int first, const GraphLink& link, const Rigid3& target_from_source) const {
    if (part(link.source) == first)
      return at(link.source) * inverse(target_from_source) * inverse(at(link.target));
    return at(link.target) * target_from_source * inverse(at(link.source));
  }

  [[nodiscard]] Rigid3 predicted(int first, const GraphLink& link, const Rigid3& first_from_second) const {
    const Rigid3 source = part(link.source) == first ? at(link.source) : first_from_second * at(link.source);
    const Rigid3 target = part(link.target) == first ? at(link.target) : first_from_second * at(link.target);
    return inverse(target) * source;
  }

  struct Proposal {
    double nats = 0.0;
    std::size_t link = 0;
    int pose = 0;
  };

  /// Poses of the links between two parts, the surest first.
  [[nodiscard]] std::vector<Proposal> proposals(const std::vector<std::size_t>& links) const {
    std::vector<Proposal> all;
    for (const std::size_t k : links) {
      if ((graph_.links[k].trust == LinkTrust::weak) && !weak_) continue;
      for (std::size_t p = 0; p < graph_.links[k].poses.size(); ++p) {
        if (!matcher_.is_left_out(k, p))
          all.push_back({matcher_.evidence(k, static_cast<int>(p)).alone(), k, static_cast<int>(p)});
      }
    }
    std::stable_sort(all.begin(), all.end(),
                     [](const Proposal& a, const Proposal& b) { return a.nats > b.nats; });
    return all;
  }

  void find_join(const Parts& parts) {
    const std::vector<std::size_t>& links = links_.at(parts);
    std::optional<PartJoin> best;
    double next = 0.0;
    std::set<std::pair<std::size_t, int>> covered;  // by a placement that was weighed
    std::size_t weighed = 0;
    for (const Proposal& proposal : proposals(links)) {
      if (covered.count({proposal.link, proposal.pose}) > 0) continue;
      if (++weighed > kMostProposals) break;
      const GraphLink& own = graph_.links[proposal.link];
      const Rigid3 placed =
          placement(parts.first, own, own.poses[static_cast<std::size_t>(proposal.pose)].target_from_source);
      JoinEvidence evidence;
      for (const std::size_t k : links) {
        const int pose = matcher_.nearest(k, predicted(parts.first, graph_.links[k], placed), kWideGate);
        if (pose < 0) continue;
        evidence.add(matcher_.evidence(k, pose));
        covered.insert({k, pose});
      }
      if (evidence.nats(kLeastRate) <= 0.0) continue;
      const double nats = evidence.nats();
      if (!best || nats > best->nats) {
        next = best ? std::max(next, best->nats) : next;
        best = {nats, 0.0, placed};
      } else {
        next = std::max(next, nats);
      }
    }
    joins_.erase(parts);
    if (!best) return;
    best->lead = best->nats - next;
    joins_[parts] = *best;
  }

  void join(const Parts parts, const PartJoin& how) {
    for (std::size_t n = 0; n < grown_.component.size(); ++n) {
      if (grown_.component[n] != parts.second) continue;
      grown_.frame_from_node[n] = how.first_from_second * grown_.frame_from_node[n];
      grown_.component[n] = parts.first;
    }
    joins_.erase(parts);
    std::set<Parts> touched;
    links_.erase(parts);
    std::vector<std::size_t> moving;
    for (auto it = links_.begin(); it != links_.end();) {
      if (it->first.first == parts.second || it->first.second == parts.second) {
        moving.insert(moving.end(), it->second.begin(), it->second.end());
        joins_.erase(it->first);
        it = links_.erase(it);
      } else {
        ++it;
      }
    }
    std::sort(moving.begin(), moving.end());
    for (const std::size_t k : moving) add(k);
    for (const auto& [other, links] : links_) {
      if (other.first == parts.first || other.second == parts.first) touched.insert(other);
    }
    for (const Parts& other : touched) find_join(other);
  }

  const PoseGraph& graph_;
  const LinkMatcher& matcher_;
  Configuration& grown_;
  bool weak_ = false;
  std::map<Parts, std::vector<std::size_t>> links_;
  std::map<Parts, PartJoin> joins_;
};

/// Of each link within a component the pose that agrees.
void accept(const PoseGraph& graph, const LinkMatcher& matcher, double gate, Configuration& configuration) {
  for (std::size_t k = 0; k < graph.links.size(); ++k) {
    const GraphLink& link = graph.links[k];
    configuration.pose[k] =
        configuration.joins(link) ? matcher.nearest(k, configuration.target_from_source(link), gate) : -1;
  }
}

/// The first node of each component.
std::vector<bool> first_nodes(const Configuration& configuration) {
  std::vector<bool> first(configuration.component.size());
  for (std::size_t n = 0; n < first.size(); ++n) first[n] = configuration.component[n] == static_cast<int>(n);
  return first;
}

/// Least squares over what agrees.
void adjust(const PoseGraph& graph, const PoseAdjustmentOptions& options, Configuration& configuration) {
  configuration.frame_from_node = adjust_poses(configuration.frame_from_node, first_nodes(configuration),
                                               edges_of(graph, configuration.pose), options)
                                      .frame_from_node;
}

/// Links that miss by no more than the configuration itself is open there agree too: each would have, had it
/// come first. Whether there are any.
bool accept_where_open(const PoseGraph& graph, const LinkMatcher& matcher, Configuration& configuration) {
  std::vector<PoseEdge> asked;
  std::vector<std::pair<std::size_t, std::size_t>> poses;
  for (std::size_t k = 0; k < graph.links.size(); ++k) {
    const GraphLink& link = graph.links[k];
    if (configuration.pose[k] >= 0 || !configuration.joins(link)) continue;
    for (std::size_t p = 0; p < link.poses.size(); ++p) {
      if (matcher.is_left_out(k, p)) continue;
      if (!is_one_place(misfit(link.poses[p], configuration.target_from_source(link)))) continue;
      poses.emplace_back(k, p);
      asked.push_back({link.source, link.target, link.poses[p]});
    }
  }
  if (asked.empty()) return false;
  const std::vector<Matrix6d> known = covariances_of(
      configuration.frame_from_node, first_nodes(configuration), edges_of(graph, configuration.pose), asked);
  std::map<std::size_t, double> nearest;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const auto& [k, p] = poses[i];
    const LinkPose& pose = graph.links[k].poses[p];
    const double squared = chi_square(misfit(pose, configuration.target_from_source(graph.links[k])),
                                      pose.covariance + known[i]);
    const auto before = nearest.find(k);
    if (squared > (before == nearest.end() ? kChiSquareBound : before->second)) continue;
    nearest[k] = squared;
    configuration.pose[k] = static_cast<int>(p);
  }
  return !nearest.empty();
}

/// Least squares over what agrees, and what agrees then, until nothing changes.
void settle(const PoseGraph& graph, const LinkMatcher& matcher, Configuration& configuration) {
  // Rounding of many motions, one after the other, would grow with each.
  for (Rigid3& pose : configuration.frame_from_node) pose.rotation = nearest_rotation(pose.rotation);
  std::vector<int> before;
  for (const double gate : {kWideGate, 4.0, 1.0, 1.0}) {
    accept(graph, matcher, gate, configuration);
    find_components(graph, configuration);
    if (configuration.pose == before) continue;
    before = configuration.pose;
    adjust(graph, {}, configuration);
  }
  accept(graph, matcher, 1.0, configuration);
  find_components(graph, configuration);
  for (int k = 0; k < kMostReopened && accept_where_open(graph, matcher, configuration); ++k) {
    adjust(graph, {false}, configuration);
    accept(graph, matcher, 1.0, configuration);
    find_components(graph, configuration);
  }
}

/// Scans and parts go to where the pairs say more; whether any did.
bool apply_best_move(const PoseGraph& graph, const LinkMatcher& matcher, MoveTo to,
                     Configuration& configuration) {
  const std::vector<Move> moves = proposed_moves(graph, matcher, configuration, to);
  const auto best = std::max_element(moves.begin(), moves.end(),
                                     [](const Move& a, const Move& b) { return a.gain() < b.gain(); });
  if (best == moves.end() || best->gain() <= kLeastGain) return false;
  for (std::size_t n = 0; n < best->side.size(); ++n) {
    if (best->side[n])
      configuration.frame_from_node[n] = best->frame_from_frame * configuration.frame_from_node[n];
  }
  return true;
}

}  // namespace

void find_components(const PoseGraph& graph, Configuration& configuration) {
  DisjointSets sets(configuration.component.size());
  for (std::size_t k = 0; k < graph.links.size(); ++k) {
    if (configuration.pose[k] >= 0)
      sets.join(static_cast<std::size_t>(graph.links[k].source),
                static_cast<std::size_t>(graph.links[k].target));
  }
  std::map<std::size_t, int> lowest;
  for (std::size_t n = 0; n < configuration.component.size(); ++n)
    configuration.component[n] = lowest.emplace(sets.find(n), static_cast<int>(n)).first->second;
}

Rigid3 Configuration::target_from_source(const GraphLink& link) const {
  return inverse(frame_from_node[static_cast<std::size_t>(link.target)]) *
         frame_from_node[static_cast<std::size_t>(link.source)];
}

bool Configuration::joins(const GraphLink& link) const {
  return component[static_cast<std::size_t>(link.source)] == component[static_cast<std::size_t>(link.target)];
}

void JoinEvidence::add(const PairEvidence& evidence) {
  chance_ += evidence.chance_nats + evidence.coincidence_nats;
  first_ = std::max(first_, evidence.coincidence_nats);
  look_alike_.add(evidence);
  if (evidence.asks_look_alike) {
    prior_otherwise_ = std::max(prior_otherwise_, evidence.look_alikes.otherwise);
    prior_alike_ = std::max(prior_alike_, evidence.look_alikes.alike);
  }
  any_ = true;
}

double JoinEvidence::nats(double rate) const {
  if (!any_) return 0.0;
  return -std::log(std::exp(first_ - chance_) +
                   rate * (prior_otherwise_ * std::exp(-look_alike_.against_otherwise()) +
                           prior_alike_ * std::exp(-look_alike_.against_alike())) +
                   kLeastOdds);
}

LinkMatcher::LinkMatcher(const PoseGraph& graph) : graph_(graph) {
  for (const GraphLink& link : graph.links) {
    information_.emplace_back();
    evidence_.emplace_back();
    left_out_.emplace_back(link.poses.size(), false);
    for (std::size_t p = 0; p < link.poses.size(); ++p) {
      information_.back().push_back(inverse_of(link.poses[p].covariance));
      evidence_.back().push_back(evidence_of(link, p));
    }
  }
}

int LinkMatcher::nearest(std::size_t link, const Rigid3& target_from_source, double gate) const {
  double least = gate * kChiSquareBound;
  int found = -1;
  const std::vector<LinkPose>& poses = graph_.links[link].poses;
  for (std::size_t p = 0; p < poses.size(); ++p) {
    if (left_out_[link][p]) continue;
    const Vector6d missed = misfit(poses[p], target_from_source);
    const double squared = missed.dot(information_[link][p] * missed);
    if (squared > least) continue;
    least = squared;
    found = static_cast<int>(p);
  }
  return found;
}

const PairEvidence& LinkMatcher::evidence(std::size_t link, int pose) const {
  return evidence_[link][static_cast<std::size_t>(pose)];
}

Configuration best_configuration(const PoseGraph& graph, const LinkMatcher& matcher) {
  Configuration best;
  best.frame_from_node.assign(static_cast<std::size_t>(graph.nodes), {});
  best.pose.assign(graph.links.size(), -1);
  for (int n = 0; n < graph.nodes; ++n) best.component.push_back(n);
  join_parts(graph, matcher, best);
  // What a moved side gave up may join elsewhere. A configuration that comes again ends the search.
  std::set<std::vector<int>> known = {best.pose};
  const auto moved = [&] {
    return apply_best_move(graph, matcher, MoveTo::other_places, best) ||
           apply_best_move(graph, matcher, MoveTo::this_place, best);
  };
  for (int k = 0; k < kMostMoves && moved(); ++k) {
    join_parts(graph, matcher, best);
    if (!known.insert(best.pose).second) break;
  }
  return best;
}

void join_parts(const PoseGraph& graph, const LinkMatcher& matcher, Configuration& configuration) {
  Growth(graph, matcher, configuration).run();
  settle(graph, matcher, configuration);
}

}  // namespace limen
