// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/project_graph.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include <Eigen/Eigenvalues>

#include "limen/base/angles.h"
#include "limen/project/adjust/plane_adjustment.h"
#include "limen/project/survey.h"

namespace limen {
namespace {

// What no pair's own deviations know of: how flat walls are, how rigid a scan is. One standard deviation.
constexpr double kFloorM = 0.004;
const double kFloorRad = radians(0.03);
constexpr double kDrawnM = 0.01;   // by how much a building misses its model
constexpr double kGivenM = 0.005;  // of poses that a file gives
const double kGivenRad = radians(0.05);
constexpr double kRivalShare = 0.5;    // of the best pose's score: a pose with less is no possibility
constexpr std::size_t kMostPoses = 9;  // of a link
constexpr double kLikelier = 0.5;      // a twin more probable than not: the pair tells nothing
constexpr double kOfUnknown = 0.1;     // probability of being wrong where a pair tells none
constexpr double kLooser = 2.0;        // an alternative's deviations against those of the best pose

Vector6d diagonal(const Vector3d& turn, const Vector3d& shift) {
  Vector6d all;
  all << turn, shift;
  return all;
}

/// What a pair says, and what it does not know of; a free direction is known to 100 m.
Matrix6d with_floor(const Matrix6d& covariance, bool model) {
  constexpr double kMost = 1e4;
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(covariance);
  const Vector6d clipped = solver.eigenvalues().cwiseMax(0.0).cwiseMin(kMost);
  const Matrix6d known = solver.eigenvectors() * clipped.asDiagonal() * solver.eigenvectors().transpose();
  const Vector6d floor =
      diagonal(Vector3d::Constant(kFloorRad), Vector3d::Constant(model ? kDrawnM : kFloorM));
  return known + Matrix6d(floor.array().square().matrix().asDiagonal());
}

class GraphMaker {
 public:
  GraphMaker(const std::vector<ProjectNode>& nodes, const std::vector<TriedPair>& pairs, double risk)
      : nodes_(nodes), pairs_(pairs), risk_(risk) {}

  ProjectGraph run() {
    graph_.nodes = static_cast<int>(nodes_.size());
    for (std::size_t k = 0; k < pairs_.size(); ++k) add_pair(k);
    add_given();
    return {std::move(graph_), std::move(pair_of_)};
  }

 private:
  [[nodiscard]] const ScanDigest& digest(int node) const {
    return nodes_[static_cast<std::size_t>(node)].digest;
  }

  void add_pair(std::size_t k) {
    const RegistrationResult& found = pairs_[k].result;
    // Loops cannot settle what a twin says: rooms built alike laid on one another close their loops too.
    const double twin = found.others ? found.others->twin : 0.0;
    if (found.outcome == Outcome::no_match || twin > kLikelier) return;
    GraphLink link;
    link.source = static_cast<int>(pairs_[k].source);
    link.target = static_cast<int>(pairs_[k].target);
    link.trust = trust_of(found, twin);
    link.twin = twin;
    link.chance = chance_of(found, twin, link.trust);
    link.poses.push_back(pose_of(link, found, found.best, 1.0));
    for (const Hypothesis& other : found.alternatives) {
      if (link.poses.size() >= kMostPoses) break;
      if (other.score < kRivalShare * found.best.score) continue;
      link.poses.push_back(pose_of(link, found, other, kLooser));
    }
    graph_.links.push_back(std::move(link));
    pair_of_.push_back(static_cast<int>(k));
  }

  /// The pair's verdict without what its own risk made of a twin.
  [[nodiscard]] LinkTrust trust_of(const RegistrationResult& found, double twin) const {
    if (found.outcome == Outcome::under_constrained) return LinkTrust::weak;
    if (found.outcome == Outcome::ambiguous && (found.rivals > 0 || twin <= 0.0)) return LinkTrust::open;
    return twin > risk_ ? LinkTrust::likely : LinkTrust::sure;
  }

  /// Probability that no pose of the link is right, or of a link with one pose that this is wrong, twins
  /// apart.
  [[nodiscard]] static double chance_of(const RegistrationResult& found, double twin, LinkTrust trust) {
    if (!found.others || !found.best.probability) return kOfUnknown;
    if (trust == LinkTrust::open) return found.others->nothing_shared + found.others->unlisted_pose;
    return std::max(0.0, 1.0 - *found.best.probability - twin);
  }

  [[nodiscard]] LinkPose pose_of(const GraphLink& link, const RegistrationResult& found,
                                 const Hypothesis& pose, double looser) const {
    const ScanDigest& source = digest(link.source);
    const ScanDigest& target = digest(link.target);
    LinkPose kept;
    kept.target_from_source = to_local(pose.target_from_source, source.local_origin, target.local_origin);
    const Rigid3 best = to_local(found.best.target_from_source, source.local_origin, target.local_origin);
    kept.centre = kept.target_from_source * (inverse(best) * (found.sigma.centre - target.local_origin));
    kept.agreeing_m2 = pose.agreeing_m2;
    kept.probability = pose.probability.value_or(1.0 / (1.0 + static_cast<double>(found.rivals)));
    if (!pose.sigma.covariance.isZero()) {
      kept.centre = pose.sigma.centre - target.local_origin;
      kept.covariance = with_floor(pose.sigma.covariance, source.model || target.model);
      return kept;
    }
    const double floor = source.model || target.model ? kDrawnM : kFloorM;
    Vector3d turn;
    Vector3d shift;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      turn[axis] = std::hypot(looser * std::min(found.sigma.rotation_rad[axis], 3.0), kFloorRad);
      shift[axis] = std::hypot(looser * std::min(found.sigma.translation_m[axis], 100.0), floor);
    }
    kept.covariance = diagonal(turn, shift).array().square().matrix().asDiagonal();
    return kept;
  }

  /// What files say of their own scans: each against the first of its file.
  void add_given() {
    std::map<std::size_t, int> first;
    for (int n = 0; n < graph_.nodes; ++n) {
      const ProjectNode& node = nodes_[static_cast<std::size_t>(n)];
      if (!node.grouped) continue;
      const auto [known, fresh] = first.emplace(node.file, n);
      if (fresh) continue;
      GraphLink link;
      link.source = n;
      link.target = known->second;
      link.trust = LinkTrust::given;
      LinkPose pose;
      pose.target_from_source.translation = digest(n).local_origin - digest(link.target).local_origin;
      pose.centre = pose.target_from_source * digest(n).middle;
      pose.covariance = diagonal(Vector3d::Constant(kGivenRad), Vector3d::Constant(kGivenM))
                            .array()
                            .square()
                            .matrix()
                            .asDiagonal();
      link.poses.push_back(pose);
      graph_.links.push_back(std::move(link));
      pair_of_.push_back(-1);
    }
  }

  const std::vector<ProjectNode>& nodes_;
  const std::vector<TriedPair>& pairs_;
  double risk_;
  PoseGraph graph_;
  std::vector<int> pair_of_;
};

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
    if (made.pair_of[k] < 0 || solved.links[k].pose != 0) continue;
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

}  // namespace

ProjectGraph make_graph(const std::vector<ProjectNode>& nodes, const std::vector<TriedPair>& pairs,
                        double risk) {
  return GraphMaker(nodes, pairs, risk).run();
}

JointFinding adjust_planes(const std::vector<ProjectNode>& nodes, const std::vector<TriedPair>& pairs,
                           const ProjectGraph& made, SolvedGraph& solved, PlacedSurvey& survey) {
  JointProblem problem = joint_problem(nodes, pairs, made, solved, survey);
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
  if (problem.observations.empty()) return finding;
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

}  // namespace limen
