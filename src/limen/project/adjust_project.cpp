// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "limen/base/angles.h"
#include "limen/project/adjust/plane_adjustment.h"
#include "limen/project/project_graph.h"
#include "limen/project/survey.h"
#include "limen/project/word_terms.h"

namespace limen {
namespace {

constexpr double kDrawnM = 0.01;  // by how much a building misses its model

// Tiles of one plane: how flat built walls are, and how many of them err independently.
constexpr double kFlatM = 0.002;
constexpr double kBendPerM = 0.0003;  // a long wall bends
constexpr double kTilesThatCount = 16.0;
constexpr double kSharedM2 = 0.3;
const double kSharedCosine = std::cos(radians(2.0));
constexpr double kSharedM = 0.04;

/// Planes of all scans, those that are one surface joined.
class SharedPlanes {
 public:
  SharedPlanes(const std::vector<ProjectNode>& nodes, const SolvedGraph& solved)
      : nodes_(nodes), solved_(solved) {
    first_.push_back(0);
    for (const ProjectNode& node : nodes) first_.push_back(first_.back() + node.digest.planes.size());
    for (std::size_t k = 0; k < first_.back(); ++k) root_.push_back(k);
  }

  /// Joins two planes where they lie in one under the solved poses as well.
  void join(int source, int source_plane, int target, int target_plane) {
    const PlaneDigest& a =
        nodes_[static_cast<std::size_t>(source)].digest.planes[static_cast<std::size_t>(source_plane)];
    const PlaneDigest& b =
        nodes_[static_cast<std::size_t>(target)].digest.planes[static_cast<std::size_t>(target_plane)];
    const Rigid3& frame_from_a = solved_.nodes[static_cast<std::size_t>(source)].frame_from_node;
    const Rigid3& frame_from_b = solved_.nodes[static_cast<std::size_t>(target)].frame_from_node;
    const Plane in_frame = transformed(frame_from_a, a.plane);
    const double cosine = in_frame.normal.dot(frame_from_b.rotation * b.plane.normal);
    if (std::abs(cosine) < kSharedCosine) return;
    if (std::abs(in_frame.signed_distance(frame_from_b * b.centroid)) > kSharedM) return;
    const std::size_t x =
        find(first_[static_cast<std::size_t>(source)] + static_cast<std::size_t>(source_plane));
    const std::size_t y =
        find(first_[static_cast<std::size_t>(target)] + static_cast<std::size_t>(target_plane));
    root_[std::max(x, y)] = std::min(x, y);
  }

  /// Observations of the planes that two nodes or more see; planes are numbered anew.
  void tell(const std::vector<bool>& taken, JointProblem& problem) {
    std::map<std::size_t, std::set<std::size_t>> seen_by;
    for_each([&](std::size_t node, std::size_t, std::size_t root) {
      if (taken[node]) seen_by[root].insert(node);
    });
    std::map<std::size_t, int> number;
    for (const auto& [root, seers] : seen_by) {
      if (seers.size() > 1) number.emplace(root, static_cast<int>(number.size()));
    }
    for_each([&](std::size_t node, std::size_t plane, std::size_t root) {
      const auto found = number.find(root);
      if (!taken[node] || found == number.end()) return;
      const ScanDigest& digest = nodes_[node].digest;
      const PlaneDigest& seen = digest.planes[plane];
      if (seen.moments.count < 3.0) return;
      PlaneObservation observation;
      observation.node = static_cast<int>(node);
      observation.plane = found->second;
      observation.moments = seen.moments;
      observation.anchor = seen.centroid;
      const double length = std::sqrt(12.0 * seen.moments.covariance().trace());
      const double own = std::hypot(kFlatM, kBendPerM * length);
      // What a trajectory drifts by is one for the whole plane.
      observation.sigma_m = std::hypot(own, digest.drift_m * std::sqrt(kTilesThatCount));
      if (digest.model) observation.sigma_m = std::hypot(own, kDrawnM * std::sqrt(kTilesThatCount));
      observation.most_points = kTilesThatCount;
      problem.observations.push_back(observation);
    });
    problem.planes = static_cast<int>(number.size());
  }

 private:
  std::size_t find(std::size_t k) {
    while (root_[k] != k) k = root_[k] = root_[root_[k]];
    return k;
  }
  template <typename Visit>
  void for_each(const Visit& visit) {
    for (std::size_t node = 0; node < nodes_.size(); ++node) {
      for (std::size_t plane = 0; plane < nodes_[node].digest.planes.size(); ++plane)
        visit(node, plane, find(first_[node] + plane));
    }
  }

  const std::vector<ProjectNode>& nodes_;
  const SolvedGraph& solved_;
  std::vector<std::size_t> first_;
  std::vector<std::size_t> root_;
};

/// By how much the joint adjustment may move a node: more is a fault of the shared planes, not a finding.
constexpr double kMostShiftM = 0.03;  // and three deviations of the links alone
const double kMostTurnRad = radians(0.3);

JointProblem joint_problem(const std::vector<ProjectNode>& nodes, const std::vector<TriedPair>& pairs,
                           const ProjectGraph& made, const SolvedGraph& solved, const PlacedSurvey& survey) {
  JointProblem problem;
  std::vector<bool> taken;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const SolvedNode& node = solved.nodes[n];
    problem.frame_from_node.push_back(node.frame_from_node);
    taken.push_back(node.component >= 0);
    // The node that the graph left where it was is the frame of its component, if control points are not.
    problem.fixed.push_back(node.component < 0 || (node.covariance.isZero() && !survey.controlled[n]));
  }
  SharedPlanes shared(nodes, solved);
  for (std::size_t k = 0; k < made.graph.links.size(); ++k) {
    const GraphLink& link = made.graph.links[k];
    if (solved.links[k].pose < 0) continue;
    problem.edges.push_back(
        {link.source, link.target, link.poses[static_cast<std::size_t>(solved.links[k].pose)]});
    if (made.pair_of[k] < 0 || solved.links[k].pose != link.best) continue;
    for (const PlaneMatch& match : pairs[static_cast<std::size_t>(made.pair_of[k])].result.matches) {
      if (match.overlap_m2 >= kSharedM2) shared.join(link.source, match.source, link.target, match.target);
    }
  }
  shared.tell(taken, problem);
  return problem;
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
                         PlacedSurvey& survey) {
  JointFinding finding;
  const bool surveyed = std::any_of(survey.points.begin(), survey.points.end(),
                                    [](const MarkedPoint& point) { return !point.sights.empty(); });
  if (surveyed) {
    JointProblem links = problem;
    links.observations.clear();
    links.planes = 0;
    links.points = survey.points;
    survey.settled = settle_points(links, survey.candidates);
    finding.contradicted = !survey.settled.firm;
    if (finding.contradicted) return finding;
    survey.points = problem.points = links.points;
    take(survey.settled.solution, solved);
    problem.frame_from_node = survey.settled.solution.frame_from_node;
  }
  const bool level = problem.frame_from_node.size() > nodes.size();
  if (problem.observations.empty() && !level) return finding;
  SettledPoints settled;
  if (surveyed)
    settled = settle_points(problem, survey.candidates);
  else
    settled.solution = adjust_jointly(problem);
  find_torn(nodes, solved, settled.solution, finding);
  if (!finding.torn.empty() || !settled.firm) return finding;
  take(settled.solution, solved);
  finding.variance_factor = settled.solution.variance_factor;
  if (!surveyed) return finding;
  // What the links alone left out stays told.
  for (std::size_t p = 0; p < settled.verdicts.size(); ++p) {
    const PointVerdict& before = survey.settled.verdicts[p];
    if (before.known_left_out && !problem.points[p].is_known()) settled.verdicts[p] = before;
  }
  survey.points = problem.points;
  survey.settled = std::move(settled);
  return finding;
}

}  // namespace

JointFinding adjust_planes(const std::vector<ProjectNode>& nodes, const std::vector<TriedPair>& pairs,
                           const ProjectGraph& made, const UserWords& words, SolvedGraph& solved,
                           PlacedSurvey& survey) {
  JointFinding finding =
      adjust_once(nodes, joint_problem(nodes, pairs, made, solved, survey), solved, survey);
  const bool spoken =
      std::any_of(words.decisions.begin(), words.decisions.end(), [](const Decision& decision) {
        return decision.kind == DecisionKind::level || decision.kind == DecisionKind::same_floor;
      });
  if (!spoken || finding.contradicted) return finding;
  // What is said of heights and levels is held against all else before it is heeded.
  const std::vector<bool> broken = broken_words(words, nodes, solved, survey.controlled);
  JointProblem problem = joint_problem(nodes, pairs, made, solved, survey);
  add_word_terms(words, broken, nodes, solved, survey.controlled, problem);
  finding = adjust_once(nodes, std::move(problem), solved, survey);
  finding.broken = broken;
  return finding;
}

}  // namespace limen
