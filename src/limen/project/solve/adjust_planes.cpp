// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/solve/adjust_planes.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "limen/base/angles.h"
#include "limen/project/solve/joint_problem.h"
#include "limen/project/solve/word_terms.h"

namespace limen {
namespace {

/// By how much the joint adjustment may move a node: more is a fault of the shared planes, not a finding.
constexpr double kMostShiftM = 0.03;  // and three deviations of the links alone
const double kMostTurnRad = radians(0.3);

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
    finding.passes = passes.stated(survey.settled.solution);
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
  finding.passes = passes.stated(settled.solution);
  finding.variance_factor = settled.solution.variance_factor;
  if (!surveyed) return finding;
  // What the links alone left out stays reported.
  for (std::size_t p = 0; p < settled.verdicts.size(); ++p) {
    const PointVerdict& before = survey.settled.verdicts[p];
    if (before.known_left_out && !problem.points[p].is_known()) settled.verdicts[p] = before;
  }
  keep_points(problem.points, survey.points);
  survey.seen_at = std::move(seen_at);
  survey.settled = std::move(settled);
  return finding;
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
