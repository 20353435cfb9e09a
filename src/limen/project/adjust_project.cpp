// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "limen/base/angles.h"
#include "limen/project/adjust/plane_adjustment.h"
#include "limen/project/passes/bent_passes.h"
#include "limen/project/project_graph.h"
#include "limen/project/shared_planes.h"
#include "limen/project/survey.h"
#include "limen/project/word_terms.h"

namespace limen {
namespace {

constexpr double kSharedM2 = 0.3;

constexpr double kMostBentM = 0.5;  // of the pass's middle, beyond its pose as a whole
const double kMostTurnedRad = radians(0.5);
constexpr int kBendRounds = 8;
constexpr int kLeastRounds = 2;
constexpr double kSettled = 1.1;  // of a rate of drift, from round to round

/// By how much the joint adjustment may move a node: more is a fault of the shared planes, not a finding.
constexpr double kMostShiftM = 0.03;  // and three deviations of the links alone
const double kMostTurnRad = radians(0.3);

/// Where a link holds a pass that is bent: the node of its parts that saw what both see.
int held_node(const TriedPair& pair, int node, bool source, const SharedPlanes& shared,
              const BentPasses& passes, JointProblem& problem) {
  if (!passes.bends(node)) return node;
  std::vector<int> planes;
  for (const PlaneMatch& match : pair.result.matches) planes.push_back(source ? match.source : match.target);
  return passes.node_at(problem, node, shared.places_of(node, planes));
}

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

/// Takes over what entered of the points.
void keep_points(const std::vector<MarkedPoint>& settled, std::vector<MarkedPoint>& points) {
  for (std::size_t p = 0; p < points.size(); ++p) {
    points[p].enters = settled[p].enters;
    points[p].known_enters = settled[p].known_enters;
    const std::vector<PointSight>& kept = settled[p].sights;
    std::vector<PointSight>& sights = points[p].sights;
    sights.erase(std::remove_if(sights.begin(), sights.end(),
                                [&](const PointSight& sight) {
                                  return std::none_of(kept.begin(), kept.end(), [&](const PointSight& k) {
                                    return k.number == sight.number;
                                  });
                                }),
                 sights.end());
  }
}

/// Where sights have their points by the adjusted poses.
void tell_places(const std::vector<MarkedPoint>& points, const std::vector<Rigid3>& frame_from_node,
                 std::vector<std::vector<Vector3d>>& seen_at) {
  for (std::size_t p = 0; p < points.size(); ++p) {
    for (const PointSight& sight : points[p].sights)
      seen_at[p][sight.number] = frame_from_node[static_cast<std::size_t>(sight.node)] * sight.x_in_node;
  }
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
    if (solved.links[k].pose < 0) continue;
    PoseEdge edge{link.source, link.target, link.poses[static_cast<std::size_t>(solved.links[k].pose)]};
    if (made.pair_of[k] >= 0 && solved.links[k].pose == link.best) {
      const TriedPair& pair = pairs[static_cast<std::size_t>(made.pair_of[k])];
      for (const PlaneMatch& match : pair.result.matches) {
        if (match.overlap_m2 >= kSharedM2) shared.join(link.source, match.source, link.target, match.target);
      }
      edge.source = held_node(pair, link.source, true, shared, passes, problem);
      edge.target = held_node(pair, link.target, false, shared, passes, problem);
    }
    problem.edges.push_back(edge);
  }
  shared.tell(taken, problem);
  problem.points = points_along(survey.points, passes, problem);
  return problem;
}

/// Passes with a way that stand in a component: what bends.
BentPasses passes_to_bend(const std::vector<ProjectNode>& nodes, const SolvedGraph& solved) {
  std::vector<PassToBend> passes;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const ScanDigest& digest = nodes[n].digest;
    if (!digest.mobile || !digest.track.way.known() || solved.nodes[n].component < 0) continue;
    passes.push_back({static_cast<int>(n), &digest.track.way, digest.drift_m});
  }
  return BentPasses(passes);
}

std::vector<int> components_of(const SolvedGraph& solved) {
  std::vector<int> components;
  for (const SolvedNode& node : solved.nodes) components.push_back(node.component);
  return components;
}

/// Three standard deviations of where a node's point lies, and of its turn.
struct Spread {
  double shift_m = 0.0;
  double turn_rad = 0.0;
};
Spread spread_of(const SolvedNode& node, const Vector3d& point) {
  const LinkPose pose{node.frame_from_node, node.covariance, node.frame_from_node.translation, 0.0};
  const Matrix6d at = moved_covariance(pose, Rigid3{}, node.frame_from_node * point);
  return {3.0 * std::sqrt(std::max(0.0, at.bottomRightCorner<3, 3>().trace())),
          3.0 * std::sqrt(std::max(0.0, at.topLeftCorner<3, 3>().trace()))};
}

/// The nodes that the adjustment would move by more than the links allow.
void find_torn(const std::vector<ProjectNode>& nodes, const SolvedGraph& solved,
               const JointSolution& solution, JointFinding& finding) {
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const Rigid3& before = solved.nodes[n].frame_from_node;
    const Vector3d middle = nodes[n].digest.middle;
    const double shift = (solution.frame_from_node[n] * middle - before * middle).norm();
    const double turn = rotation_angle(solution.frame_from_node[n].rotation.transpose() * before.rotation);
    const Spread allowed = spread_of(solved.nodes[n], middle);
    if (shift <= kMostShiftM + allowed.shift_m && turn <= kMostTurnRad + allowed.turn_rad) continue;
    finding.torn.push_back(static_cast<int>(n));
    finding.most_moved_m = std::max(finding.most_moved_m, shift);
  }
}

void take(const JointSolution& solution, SolvedGraph& solved) {
  for (std::size_t n = 0; n < solved.nodes.size(); ++n) {
    SolvedNode& node = solved.nodes[n];
    if (node.component < 0) continue;
    node.frame_from_node = solution.frame_from_node[n];
    node.covariance = solution.covariance[n];
  }
}

/// The adjustment of a problem, its points and planes.
JointFinding adjust_once(const std::vector<ProjectNode>& nodes, JointProblem problem, SolvedGraph& solved,
                         PlacedSurvey& survey, const BentPasses& passes, bool level = false) {
  JointFinding finding;
  const bool surveyed = std::any_of(survey.points.begin(), survey.points.end(),
                                    [](const MarkedPoint& point) { return !point.sights.empty(); });
  if (surveyed) {
    JointProblem links = problem;
    links.observations.clear();
    links.planes = 0;
    survey.settled = settle_points(links, survey.candidates);
    finding.contradicted = !survey.settled.firm;
    if (finding.contradicted) return finding;
    tell_places(problem.points, survey.settled.solution.frame_from_node, survey.seen_at);
    passes.settle_frames(problem, components_of(solved), survey.settled.solution);
    problem.points = links.points;
    keep_points(links.points, survey.points);
    finding.passes = passes.told(survey.settled.solution);
    take(survey.settled.solution, solved);
    problem.frame_from_node = survey.settled.solution.frame_from_node;
  }
  if (problem.observations.empty() && !level) return finding;
  SettledPoints settled;
  std::vector<std::vector<Vector3d>> seen_at = survey.seen_at;
  if (surveyed) {
    const std::vector<MarkedPoint> points = problem.points;
    settled = settle_points(problem, survey.candidates);
    tell_places(points, settled.solution.frame_from_node, seen_at);
  } else {
    settled.solution = adjust_jointly(problem);
  }
  passes.settle_frames(problem, components_of(solved), settled.solution);
  find_torn(nodes, solved, settled.solution, finding);
  if (!finding.torn.empty() || !settled.firm) return finding;
  take(settled.solution, solved);
  finding.passes = passes.told(settled.solution);
  finding.variance_factor = settled.solution.variance_factor;
  if (!surveyed) return finding;
  // What the links alone left out stays told.
  for (std::size_t p = 0; p < settled.verdicts.size(); ++p) {
    const PointVerdict& before = survey.settled.verdicts[p];
    if (before.known_left_out && !problem.points[p].is_known()) settled.verdicts[p] = before;
  }
  keep_points(problem.points, survey.points);
  survey.seen_at = std::move(seen_at);
  survey.settled = std::move(settled);
  return finding;
}

/// The shape of the passes, and how fast they drift, in the frame as it is solved so far: planes are joined
/// anew once passes are bent.
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

/// No trajectory that deserves the name is off by more: then something else is wrong, and passes stay rigid.
bool drift_is_plausible(const std::vector<BentPass>& passes) {
  return std::all_of(passes.begin(), passes.end(), [](const BentPass& pass) {
    return std::all_of(pass.knots.begin(), pass.knots.end(), [](const BentKnot& knot) {
      return knot.value.head<3>().norm() < kMostTurnedRad && knot.value.tail<3>().norm() < kMostBentM;
    });
  });
}

JointFinding adjust_with(const std::vector<ProjectNode>& nodes, const std::vector<TriedPair>& pairs,
                         const ProjectGraph& made, const UserWords& words, SolvedGraph& solved,
                         PlacedSurvey& survey, BentPasses& passes) {
  if (passes.any()) bend(nodes, pairs, made, solved, survey, passes);
  JointFinding finding =
      adjust_once(nodes, joint_problem(nodes, pairs, made, solved, survey, passes), solved, survey, passes);
  const bool spoken =
      std::any_of(words.decisions.begin(), words.decisions.end(), [](const Decision& decision) {
        return decision.kind == DecisionKind::level || decision.kind == DecisionKind::same_floor;
      });
  if (!spoken || finding.contradicted) return finding;
  // What is said of heights and levels is held against all else before it is heeded.
  const std::vector<bool> broken = broken_words(words, nodes, solved, survey.controlled);
  JointProblem problem = joint_problem(nodes, pairs, made, solved, survey, passes);
  const std::size_t before = problem.frame_from_node.size();
  add_word_terms(words, broken, nodes, solved, survey.controlled, problem);
  const bool level = problem.frame_from_node.size() > before;
  finding = adjust_once(nodes, std::move(problem), solved, survey, passes, level);
  finding.broken = broken;
  return finding;
}

}  // namespace

JointFinding adjust_planes(const std::vector<ProjectNode>& nodes, const std::vector<TriedPair>& pairs,
                           const ProjectGraph& made, const UserWords& words, SolvedGraph& solved,
                           PlacedSurvey& survey) {
  BentPasses passes = passes_to_bend(nodes, solved);
  if (passes.any()) {
    SolvedGraph bent_solved = solved;
    PlacedSurvey bent_survey = survey;
    JointFinding finding = adjust_with(nodes, pairs, made, words, bent_solved, bent_survey, passes);
    if (finding.torn.empty() && !finding.contradicted && drift_is_plausible(finding.passes)) {
      solved = std::move(bent_solved);
      survey = std::move(bent_survey);
      return finding;
    }
  }
  BentPasses none({});
  return adjust_with(nodes, pairs, made, words, solved, survey, none);
}

}  // namespace limen
