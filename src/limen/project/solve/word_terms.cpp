// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/solve/word_terms.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "limen/base/angles.h"
#include "limen/geometry/rotation_between.h"

namespace limen {
namespace {

const double kLevelRad = radians(0.02);  // how level a scan is that is called so
constexpr double kWordFloorM = 0.007;    // by how much two floors of one height differ
constexpr double kFarTilt = 3.7;         // deviations, two freedoms, once in a thousand
constexpr double kFarHeight = 3.3;       // one freedom
const double kLevelCosine = std::cos(radians(3.0));
constexpr double kBelowM = 0.5;
constexpr double kNarrowestM = 0.05;  // no plane is known to be narrower
constexpr double kLeastFloorM2 = 1.0;
constexpr double kFreeRad2 = 1e2;  // what a word on level does not speak of
constexpr double kFreeM2 = 1e6;
constexpr double kFloorFreeM2 = 1e4;

Vector3d up_in(const ScanDigest& digest) {
  return digest.upright_from_scan.row(2).transpose();
}

/// The turn about a level axis that brings `up` to z.
Matrix3d levelled(const Vector3d& up) {
  return rotation_between(up, Vector3d::UnitZ());
}

/// Tiles per square metre of a level plane below `from`, as if they were normally distributed. What is seen
/// of the street through a window is not below a scanner, and what is below it is seen densely.
double tiles_below(const PlaneDigest& plane, const Matrix3d& level_from_scan, const Vector3d& from) {
  const Matrix3d spread = level_from_scan *
                          (plane.moments.covariance() + kNarrowestM * kNarrowestM * Matrix3d::Identity()) *
                          level_from_scan.transpose();
  const Eigen::Matrix2d in_plan = spread.topLeftCorner<2, 2>();
  const Vector2d off = (level_from_scan * (from - plane.centroid - plane.moments.mean())).head<2>();
  return plane.moments.count * std::exp(-0.5 * off.dot(in_plan.inverse() * off)) /
         std::sqrt(in_plan.determinant());
}

PoseEdge level_edge(int node, int up, const Rigid3& up_from_node) {
  PoseEdge edge;
  edge.source = node;
  edge.target = up;
  edge.pose.target_from_source = up_from_node;
  edge.pose.target_from_source.rotation =
      levelled(up_from_node.rotation * Vector3d::UnitZ()) * up_from_node.rotation;
  Vector6d variances;
  variances << kLevelRad * kLevelRad, kLevelRad * kLevelRad, kFreeRad2, kFreeM2, kFreeM2, kFreeM2;
  edge.pose.covariance = variances.asDiagonal();
  edge.pose.centre = up_from_node.translation;
  return edge;
}

/// The words on level scans by component, and those on floors whose scans stand in one.
struct SpokenOf {
  std::map<int, std::vector<std::size_t>> level;
  std::vector<std::size_t> floors;
};

SpokenOf spoken_of(const UserWords& words, const std::vector<bool>& broken, const SolvedGraph& solved) {
  SpokenOf spoken;
  for (std::size_t k = 0; k < words.decisions.size(); ++k) {
    if (words.nodes[k].empty() || (k < broken.size() && broken[k])) continue;
    const int component = solved.nodes[static_cast<std::size_t>(words.nodes[k].front())].component;
    if (component < 0) continue;
    const int other = solved.nodes[static_cast<std::size_t>(words.nodes[k].back())].component;
    if (words.decisions[k].kind == DecisionKind::level) spoken.level[component].push_back(k);
    if (words.decisions[k].kind == DecisionKind::same_floor && component == other) spoken.floors.push_back(k);
  }
  return spoken;
}

class WordSolution {
 public:
  WordSolution(const UserWords& words, const std::vector<ProjectNode>& nodes, const SolvedGraph& solved,
               const std::vector<bool>& controlled)
      : words_(words), nodes_(nodes), solved_(solved), controlled_(controlled) {}

  [[nodiscard]] int node_of(std::size_t k) const { return words_.nodes[k].front(); }
  [[nodiscard]] const Rigid3& pose(int node) const {
    return solved_.nodes[static_cast<std::size_t>(node)].frame_from_node;
  }
  [[nodiscard]] const Matrix6d& covariance(int node) const {
    return solved_.nodes[static_cast<std::size_t>(node)].covariance;
  }
  [[nodiscard]] const ScanDigest& digest(int node) const {
    return nodes_[static_cast<std::size_t>(node)].digest;
  }
  [[nodiscard]] bool surveyed(const std::vector<std::size_t>& level) const {
    return controlled_[static_cast<std::size_t>(node_of(level.front()))];
  }

  /// What is up in the frame: the survey's, or that of most of the scans that are asked to be level.
  [[nodiscard]] Vector3d up_of(const std::vector<std::size_t>& level) const {
    if (surveyed(level)) return Vector3d::UnitZ();
    Vector3d up = Vector3d::Zero();
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      std::vector<double> values;
      for (const std::size_t k : level) values.push_back(pose(node_of(k)).rotation(axis, 2));
      std::sort(values.begin(), values.end());
      up[axis] = 0.5 * (values[(values.size() - 1) / 2] + values[values.size() / 2]);
    }
    return up.normalized();
  }

  [[nodiscard]] bool says_what_is_up(const std::vector<std::size_t>& level) const {
    return level.size() >= 2 || surveyed(level);
  }

  void add_level(const std::vector<std::size_t>& level, JointProblem& problem) const {
    if (!says_what_is_up(level)) return;
    Rigid3 frame_from_up;
    frame_from_up.rotation = levelled(up_of(level)).transpose();
    const int number = static_cast<int>(problem.frame_from_node.size());
    problem.frame_from_node.push_back(frame_from_up);
    problem.fixed.push_back(surveyed(level));
    for (const std::size_t k : level)
      problem.edges.push_back(level_edge(node_of(k), number, inverse(frame_from_up) * pose(node_of(k))));
  }

  /// One number of the pose between two scans: the height of one floor above the other.
  void add_floor(std::size_t k, JointProblem& problem) const {
    const std::optional<double> apart = height(k);
    if (!apart) return;
    const int source = words_.nodes[k].front();
    const int target = words_.nodes[k].back();
    PoseEdge edge;
    edge.source = source;
    edge.target = target;
    edge.pose.target_from_source = inverse(pose(target)) * pose(source);
    edge.pose.centre = edge.pose.target_from_source * floor_place(source);
    const Vector3d up = up_in(digest(target));
    edge.pose.target_from_source.translation -= *apart * up;
    edge.pose.centre -= *apart * up;
    edge.pose.covariance.setZero();
    edge.pose.covariance.topLeftCorner<3, 3>() = kFreeRad2 * Matrix3d::Identity();
    edge.pose.covariance.bottomRightCorner<3, 3>() =
        kFloorFreeM2 * (Matrix3d::Identity() - up * up.transpose()) +
        kWordFloorM * kWordFloorM * up * up.transpose();
    problem.edges.push_back(edge);
  }

  [[nodiscard]] bool level_broken(std::size_t k, const std::vector<std::size_t>& level) const {
    const Vector3d lean = pose(node_of(k)).rotation.col(2).cross(up_of(level));
    Matrix3d of_node = covariance(node_of(k)).topLeftCorner<3, 3>();
    // What is up is known no better than the scans that tell it.
    for (const std::size_t other : level) {
      if (!surveyed(level))
        of_node += covariance(node_of(other)).topLeftCorner<3, 3>() / static_cast<double>(level.size());
    }
    const double along = lean.norm() < 1e-12 ? 0.0 : lean.normalized().dot(of_node * lean.normalized());
    return lean.norm() > kFarTilt * std::sqrt(kLevelRad * kLevelRad + along);
  }

  [[nodiscard]] bool floor_broken(std::size_t k) const {
    const std::optional<double> apart = height(k);
    if (!apart) return false;
    const int source = words_.nodes[k].front();
    const int target = words_.nodes[k].back();
    const Vector3d at = pose(source) * floor_place(source);
    const Vector3d up = pose(target).rotation * up_in(digest(target));
    double variance = kWordFloorM * kWordFloorM;
    for (const int node : {source, target}) {
      const LinkPose known{pose(node), covariance(node), pose(node).translation, 0.0};
      variance += up.dot(moved_covariance(known, Rigid3{}, at).bottomRightCorner<3, 3>() * up);
    }
    return std::abs(*apart) > kFarHeight * std::sqrt(variance);
  }

 private:
  [[nodiscard]] Vector3d floor_place(int node) const {
    return digest(node).planes[static_cast<std::size_t>(floor_of(digest(node)))].centroid;
  }
  [[nodiscard]] std::optional<double> height(std::size_t k) const {
    const int source = words_.nodes[k].front();
    const int target = words_.nodes[k].back();
    return floors_apart(digest(source), digest(target), inverse(pose(target)) * pose(source));
  }

  const UserWords& words_;
  const std::vector<ProjectNode>& nodes_;
  const SolvedGraph& solved_;
  const std::vector<bool>& controlled_;
};

}  // namespace

int floor_of(const ScanDigest& digest) {
  const Vector3d up = up_in(digest);
  const Vector3d from = digest.stations.empty() ? digest.middle : digest.stations.front();
  int best = -1;
  double most = 0.0;
  for (std::size_t k = 0; k < digest.planes.size(); ++k) {
    const PlaneDigest& plane = digest.planes[k];
    if (std::abs(plane.plane.normal.dot(up)) < kLevelCosine || plane.area_m2 < kLeastFloorM2) continue;
    if ((plane.centroid - from).dot(up) > -kBelowM || plane.moments.count < 3.0) continue;
    const double density = tiles_below(plane, levelled(up), from);
    if (density <= most) continue;
    most = density;
    best = static_cast<int>(k);
  }
  return best;
}

std::vector<std::string> idle_words(const UserWords& words, const std::vector<ProjectNode>& nodes,
                                    const SolvedGraph& solved, const std::vector<bool>& controlled) {
  std::vector<std::string> reasons(words.decisions.size());
  const SpokenOf spoken = spoken_of(words, {}, solved);
  const WordSolution solution(words, nodes, solved, controlled);
  for (std::size_t k = 0; k < reasons.size(); ++k) {
    if (words.nodes[k].empty()) continue;
    const int component = solved.nodes[static_cast<std::size_t>(words.nodes[k].front())].component;
    if (words.decisions[k].kind == DecisionKind::level) {
      const auto level = spoken.level.find(component);
      if (level == spoken.level.end())
        reasons[k] = "nothing joins the scan to others";
      else if (!solution.says_what_is_up(level->second))
        reasons[k] = "it takes another level scan of its group, or control points";
    }
    if (words.decisions[k].kind != DecisionKind::same_floor) continue;
    if (std::find(spoken.floors.begin(), spoken.floors.end(), k) == spoken.floors.end()) {
      reasons[k] = "nothing joins the two scans";
      continue;
    }
    for (std::size_t end = 0; end < words.nodes[k].size() && reasons[k].empty(); ++end) {
      if (floor_of(nodes[static_cast<std::size_t>(words.nodes[k][end])].digest) < 0)
        reasons[k] = "no floor was seen by " + words.decisions[k].scans[end];
    }
  }
  return reasons;
}

std::optional<double> floors_apart(const ScanDigest& source, const ScanDigest& target,
                                   const Rigid3& target_from_source) {
  const int own = floor_of(source);
  const int other = floor_of(target);
  if (own < 0 || other < 0) return {};
  const Vector3d up = up_in(target);
  const Vector3d there = target_from_source * source.planes[static_cast<std::size_t>(own)].centroid;
  return (there - target.planes[static_cast<std::size_t>(other)].centroid).dot(up);
}

void add_word_terms(const UserWords& words, const std::vector<bool>& broken,
                    const std::vector<ProjectNode>& nodes, const SolvedGraph& solved,
                    const std::vector<bool>& controlled, JointProblem& problem) {
  const SpokenOf spoken = spoken_of(words, broken, solved);
  const WordSolution solution(words, nodes, solved, controlled);
  for (const auto& [component, level] : spoken.level) solution.add_level(level, problem);
  for (const std::size_t k : spoken.floors) solution.add_floor(k, problem);
}

std::vector<bool> broken_words(const UserWords& words, const std::vector<ProjectNode>& nodes,
                               const SolvedGraph& solved, const std::vector<bool>& controlled) {
  std::vector<bool> broken(words.decisions.size(), false);
  const SpokenOf spoken = spoken_of(words, broken, solved);
  const WordSolution solution(words, nodes, solved, controlled);
  for (const auto& [component, level] : spoken.level) {
    for (const std::size_t k : level) broken[k] = solution.level_broken(k, level);
  }
  for (const std::size_t k : spoken.floors) broken[k] = solution.floor_broken(k);
  return broken;
}

}  // namespace limen
