// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/solve/joint_problem.h"

#include <algorithm>
#include <map>

#include "limen/base/angles.h"

namespace limen {
namespace {

constexpr double kSharedM2 = 0.3;
constexpr double kMostBentM = 0.5;  // of the pass's middle, beyond its pose as a whole
const double kMostTurnedRad = radians(0.5);
constexpr int kBendRounds = 8;
constexpr int kLeastRounds = 2;
constexpr double kSettled = 1.1;  // of a rate of drift, from round to round

/// The points as the adjustment has them: what a bent pass saw moves with that part of its way.
std::vector<MarkedPoint> points_along(std::vector<MarkedPoint> points, const BentPasses& passes,
                                      JointProblem& problem) {
  for (MarkedPoint& point : points) {
    for (PointSight& sight : point.sights) {
      if (!sight.place || !passes.bends(sight.node)) continue;
      sight.strayed_m = passes.unfollowed_m(sight.node);
      sight.node = passes.node_at(problem, sight.node, {*sight.place}, false);
    }
  }
  return points;
}

/// Whether the targets that gave a link are observations of their own.
bool enter_themselves(const std::vector<MarkedPoint>& points, const GraphLink& link) {
  const auto sees = [](const MarkedPoint& point, int node) {
    return std::any_of(point.sights.begin(), point.sights.end(),
                       [node](const PointSight& sight) { return sight.node == node; });
  };
  return std::count_if(points.begin(), points.end(), [&](const MarkedPoint& point) {
           return sees(point, link.source) && sees(point, link.target);
         }) >= 3;
}

/// Whether a plane that two scans share faces as one that lies beside its counterpart: which of the two was
/// moved is not known.
bool may_have_moved(const PlaneMatch& match, const TriedPair& pair, const std::vector<ProjectNode>& nodes) {
  constexpr double kFacesAlike = 0.7;
  const ScanDigest& source = nodes[pair.source].digest;
  if (source.model || nodes[pair.target].digest.model) return false;
  const auto normal = [&](int plane) -> const Vector3d& {
    return source.planes[static_cast<std::size_t>(plane)].plane.normal;
  };
  return std::any_of(pair.result.moved.begin(), pair.result.moved.end(), [&](const PlaneMatch& moved) {
    return std::abs(normal(match.source).dot(normal(moved.source))) > kFacesAlike;
  });
}

}  // namespace

BentPasses passes_to_bend(const std::vector<ProjectNode>& nodes, const SolvedGraph& solved) {
  std::vector<PassToBend> passes;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const ScanDigest& digest = nodes[n].digest;
    if (!digest.mobile || !digest.track.way.known() || solved.nodes[n].component < 0) continue;
    PassToBend pass;
    pass.node = static_cast<int>(n);
    pass.way = &digest.track.way;
    pass.drift_m = nodes[n].strays_m();
    if (nodes[n].drift) pass.turn_rate_rad2_per_m = nodes[n].drift->turn_rate_rad2_per_m;
    passes.push_back(pass);
  }
  return BentPasses(passes);
}

std::vector<double> common_places(const std::vector<ProjectNode>& nodes, const TriedPair& pair,
                                  const Rigid3& target_from_source, bool source, const SharedPlanes& shared) {
  const std::vector<PlaneDigest>& others = nodes[source ? pair.target : pair.source].digest.planes;
  std::vector<SharedPlanes::SeenByBoth> seen;
  for (const PlaneMatch& match : pair.result.matches)
    seen.push_back({source ? match.source : match.target,
                    &others[static_cast<std::size_t>(source ? match.target : match.source)]});
  return shared.places_of(static_cast<int>(source ? pair.source : pair.target), seen,
                          source ? target_from_source : inverse(target_from_source));
}

JointProblem joint_problem(const std::vector<ProjectNode>& nodes, const std::vector<TriedPair>& pairs,
                           const ProjectGraph& made, const SolvedGraph& solved, const PlacedSurvey& survey,
                           BentPasses& passes) {
  JointProblem problem;
  std::vector<bool> taken;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const SolvedNode& node = solved.nodes[n];
    problem.frame_from_node.push_back(node.frame_from_node);
    taken.push_back(node.component >= 0);
    // The node that the graph left where it was is the frame of its component, if control points are not.
    problem.fixed.push_back(node.component < 0 || (node.covariance.isZero() && !survey.controlled[n]));
  }
  passes.add_to(problem);
  SharedPlanes shared(nodes, solved, passes);
  for (std::size_t k = 0; k < made.graph.links.size(); ++k) {
    const GraphLink& link = made.graph.links[k];
    if (solved.links[k].pose < 0 || (link.by_targets && enter_themselves(survey.points, link))) continue;
    PoseEdge edge{link.source, link.target, link.poses[static_cast<std::size_t>(solved.links[k].pose)]};
    if (made.pair_of[k] >= 0 && solved.links[k].pose == link.best) {
      const TriedPair& pair = pairs[static_cast<std::size_t>(made.pair_of[k])];
      for (const PlaneMatch& match : pair.result.matches) {
        if (match.overlap_m2 >= kSharedM2 && !may_have_moved(match, pair, nodes)) shared.join(edge, match);
      }
      for (const bool source : {true, false}) {
        int& node = source ? edge.source : edge.target;
        if (passes.bends(node))
          node = passes.node_at(problem, node,
                                common_places(nodes, pair, edge.pose.target_from_source, source, shared));
      }
    }
    problem.edges.push_back(edge);
  }
  for (std::size_t k = 0; k < made.graph.measured_in_place.size(); ++k) {
    if (solved.in_place[k]) problem.edges.push_back(made.graph.measured_in_place[k]);
  }
  shared.tell(taken, problem);
  problem.points = points_along(survey.points, passes, problem);
  return problem;
}

void give_references(const std::vector<bool>& controlled, SolvedGraph& solved) {
  std::map<int, SolvedNode*> references;  // null: the component has a frame
  for (std::size_t n = 0; n < solved.nodes.size(); ++n) {
    SolvedNode& node = solved.nodes[n];
    if (node.component < 0) continue;
    const auto [known, fresh] = references.emplace(node.component, &node);
    SolvedNode*& reference = known->second;
    if (reference == nullptr) continue;
    const bool firmer = reference->state != NodeState::registered && node.state == NodeState::registered;
    if (firmer) reference = &node;
    if (node.covariance.isZero() || controlled[n]) reference = nullptr;
  }
  for (const auto& [component, reference] : references) {
    if (reference != nullptr) reference->covariance.setZero();
  }
}

std::vector<int> components_of(const SolvedGraph& solved) {
  std::vector<int> components;
  for (const SolvedNode& node : solved.nodes) components.push_back(node.component);
  return components;
}

void bend(const std::vector<ProjectNode>& nodes, const std::vector<TriedPair>& pairs,
          const ProjectGraph& made, SolvedGraph solved, const PlacedSurvey& survey, BentPasses& passes) {
  for (int round = 0; round < kBendRounds; ++round) {
    JointProblem problem = joint_problem(nodes, pairs, made, solved, survey, passes);
    JointSolution solution = adjust_jointly(problem);
    passes.settle_frames(problem, components_of(solved), solution);
    const double change = passes.take(problem, solution);
    for (std::size_t n = 0; n < solved.nodes.size(); ++n)
      solved.nodes[n].frame_from_node = solution.frame_from_node[n];
    if (round >= kLeastRounds && change < kSettled) break;
  }
}

bool drift_is_plausible(const std::vector<BentPass>& passes) {
  return std::all_of(passes.begin(), passes.end(), [](const BentPass& pass) {
    return std::all_of(pass.knots.begin(), pass.knots.end(), [](const BentKnot& knot) {
      return knot.value.head<3>().norm() < kMostTurnedRad && knot.value.tail<3>().norm() < kMostBentM;
    });
  });
}

}  // namespace limen
