// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/solve/straighten_links.h"

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "limen/project/solve/joint_problem.h"

namespace limen {
namespace {

constexpr double kUnreportedM2 = 1e6;  // of an edge that is there to be reported, and holds nothing

/// The scans and what joins them, without the node of a survey.
struct ScansOnly {
  ProjectGraph made;
  SolvedGraph solved;
  std::vector<std::size_t> link;  ///< of each link: its number in the whole graph
};

ScansOnly scans_only(const ProjectGraph& made, const SolvedGraph& solved, std::size_t nodes) {
  ScansOnly scans;
  scans.made.graph.nodes = static_cast<int>(nodes);
  scans.solved.nodes.assign(solved.nodes.begin(), solved.nodes.begin() + static_cast<std::ptrdiff_t>(nodes));
  for (std::size_t k = 0; k < made.graph.links.size(); ++k) {
    const GraphLink& link = made.graph.links[k];
    if (std::max(link.source, link.target) >= scans.made.graph.nodes) continue;
    scans.made.graph.links.push_back(link);
    scans.made.pair_of.push_back(made.pair_of[k]);
    scans.solved.links.push_back(solved.links[k]);
    scans.link.push_back(k);
  }
  give_references(std::vector<bool>(nodes, false), scans.solved);
  return scans;
}

/// The part of a pass that a link holds, against the pass as a whole.
struct HeldPart {
  std::size_t link = 0;
  bool source = true;
  int whole = -1;
  int part = -1;
  std::size_t edge = 0;  ///< of the adjustment: tells how well it is known, and holds nothing
  Matrix3d spread_m2;    ///< of the common surface by the places where the pass saw it; axes of the pass
};

class Straightener {
 public:
  Straightener(const std::vector<ProjectNode>& nodes, const std::vector<TriedPair>& pairs,
               const ProjectGraph& made, const SolvedGraph& solved)
      : nodes_(nodes), pairs_(pairs), whole_(made.graph), scans_(scans_only(made, solved, nodes.size())) {}

  std::optional<PoseGraph> run() {
    BentPasses passes = passes_to_bend(nodes_, scans_.solved);
    if (!passes.any()) return std::nullopt;
    PlacedSurvey none;
    none.controlled.assign(nodes_.size(), false);
    bend(nodes_, pairs_, scans_.made, scans_.solved, none, passes);
    JointProblem problem = joint_problem(nodes_, pairs_, scans_.made, scans_.solved, none, passes);
    const SharedPlanes shared(nodes_, scans_.solved, passes);
    for (std::size_t k = 0; k < scans_.made.graph.links.size(); ++k) {
      for (const bool source : {true, false}) hold(k, source, shared, passes, problem);
    }
    const JointSolution solution = adjust_jointly(problem);
    if (!drift_is_plausible(passes.stated(solution))) return std::nullopt;
    for (const HeldPart& part : parts_) straighten(part, passes.unfollowed_m(part.whole), solution);
    return std::move(whole_);
  }

 private:
  [[nodiscard]] const GraphLink& link(std::size_t k) const { return scans_.made.graph.links[k]; }
  [[nodiscard]] bool is_joined(std::size_t k) const {
    const int component = scans_.solved.nodes[static_cast<std::size_t>(link(k).source)].component;
    return component >= 0 &&
           component == scans_.solved.nodes[static_cast<std::size_t>(link(k).target)].component;
  }

  void hold(std::size_t k, bool source, const SharedPlanes& shared, const BentPasses& passes,
            JointProblem& problem) {
    const int whole = source ? link(k).source : link(k).target;
    if (scans_.made.pair_of[k] < 0 || !is_joined(k) || !passes.bends(whole)) return;
    const TriedPair& pair = pairs_[static_cast<std::size_t>(scans_.made.pair_of[k])];
    const LinkPose& pose = best(k);
    HeldPart held{k, source, whole, -1, problem.edges.size(), Matrix3d::Zero()};
    const std::vector<double> places = common_places(nodes_, pair, pose.target_from_source, source, shared);
    held.part = passes.node_at(problem, whole, places);
    PoseEdge edge;
    edge.source = held.part;
    edge.target = whole;
    edge.pose.target_from_source = inverse(problem.frame_from_node[static_cast<std::size_t>(whole)]) *
                                   problem.frame_from_node[static_cast<std::size_t>(held.part)];
    edge.pose.centre = source ? inverse(pose.target_from_source) * pose.centre : pose.centre;
    edge.pose.covariance = kUnreportedM2 * Matrix6d::Identity();
    edge.stated = true;
    problem.edges.push_back(edge);
    held.spread_m2 = spread_of(whole, places, edge.pose.centre, passes);
    parts_.push_back(held);
  }

  /// How far the bend parts what was seen at these places. The pair's pose is a mean over them by weights
  /// that nobody knows.
  [[nodiscard]] Matrix3d spread_of(int whole, const std::vector<double>& places, const Vector3d& at,
                                   const BentPasses& passes) const {
    const Rigid3& frame_from_whole = scans_.solved.nodes[static_cast<std::size_t>(whole)].frame_from_node;
    PointMoments moments;
    for (const double place : places) {
      const Rigid3 whole_from_part =
          inverse(frame_from_whole) * passes.pose_at(whole, frame_from_whole, place);
      moments.add(whole_from_part * at - at);
    }
    return moments.covariance();
  }

  /// The pose that matched planes belong to.
  [[nodiscard]] const LinkPose& best(std::size_t k) const {
    return link(k).poses[static_cast<std::size_t>(link(k).best)];
  }

  void straighten(const HeldPart& held, double unfollowed_m, const JointSolution& solution) {
    const Rigid3 whole_from_part = inverse(solution.frame_from_node[static_cast<std::size_t>(held.whole)]) *
                                   solution.frame_from_node[static_cast<std::size_t>(held.part)];
    GraphLink& kept = whole_.links[scans_.link[held.link]];
    LinkPose& pose = kept.poses[static_cast<std::size_t>(kept.best)];
    // Instead of what the pass as a whole strays: what is left of that here.
    const double strays_m = nodes_[static_cast<std::size_t>(held.whole)].strays_m();
    pose.covariance.diagonal().tail<3>().array() += unfollowed_m * unfollowed_m - strays_m * strays_m;
    Matrix6d open = solution.edge_covariance[held.edge];
    open.bottomRightCorner<3, 3>() += held.spread_m2;
    if (held.source) {
      // A motion of the pass about the point where the two meet, in the target's axes.
      const LinkPose own{pose.target_from_source, open, inverse(pose.target_from_source) * pose.centre};
      pose.covariance += moved_covariance(own, pose.target_from_source, pose.centre);
      pose.target_from_source = pose.target_from_source * inverse(whole_from_part);
    } else {
      pose.covariance += open;
      pose.target_from_source = whole_from_part * pose.target_from_source;
      pose.centre = whole_from_part * pose.centre;
    }
  }

  const std::vector<ProjectNode>& nodes_;
  const std::vector<TriedPair>& pairs_;
  PoseGraph whole_;
  ScansOnly scans_;
  std::vector<HeldPart> parts_;
};

}  // namespace

std::optional<PoseGraph> straightened(const std::vector<ProjectNode>& nodes,
                                      const std::vector<TriedPair>& pairs, const ProjectGraph& made,
                                      const SolvedGraph& solved) {
  return Straightener(nodes, pairs, made, solved).run();
}

}  // namespace limen
