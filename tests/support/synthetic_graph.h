// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "limen/base/angles.h"
#include "limen/base/random.h"
#include "limen/geometry/random_vectors.h"
#include "limen/project/graph/pose_graph.h"

namespace limen {

/// A building of stations on a grid, with links between near ones whose errors follow their covariance, and
/// the truth of it.
struct SyntheticGraph {
  PoseGraph graph;
  std::vector<Rigid3> world_from_node;
  std::vector<bool> is_false;  ///< of each link: replaced by a pose that means nothing
};

inline Rigid3 random_pose(RandomStream& random, double reach_m) {
  Rigid3 pose;
  pose.rotation = rotation_exp(Vector3d(0, 0, random.uniform(-3.0, 3.0)));
  pose.translation = {random.uniform(-reach_m, reach_m), random.uniform(-reach_m, reach_m),
                      random.uniform(-0.2, 0.2)};
  return pose;
}

/// A pose as a pair of scans would give it: the true one and an error by its covariance.
inline LinkPose measured_pose(const Rigid3& truth, double agreeing_m2, RandomStream& random) {
  constexpr double kShift = 0.004;
  const double turn = radians(0.03);
  LinkPose pose;
  Vector6d error;
  for (Eigen::Index k = 0; k < 6; ++k) error[k] = random.normal() * (k < 3 ? turn : kShift);
  pose.covariance = Matrix6d::Zero();
  for (Eigen::Index k = 0; k < 6; ++k) pose.covariance(k, k) = k < 3 ? turn * turn : kShift * kShift;
  const Vector3d centre = truth * uniform_vector(Vector3d(-2, -2, 0), Vector3d(2, 2, 2), random);
  Rigid3 noisy;
  noisy.rotation = rotation_exp(error.head<3>()) * truth.rotation;
  noisy.translation = rotation_exp(error.head<3>()) * (truth.translation - centre) + centre + error.tail<3>();
  pose.target_from_source = noisy;
  pose.centre = centre;
  pose.agreeing_m2 = agreeing_m2;
  return pose;
}

/// `columns` x `rows` stations 4 m apart, each linked to the `partners` nearest; `false_share` of the links
/// are replaced.
inline SyntheticGraph synthetic_graph(int columns, int rows, std::size_t partners, double false_share,
                                      std::uint64_t seed) {
  RandomStream random(seed, 7);
  SyntheticGraph made;
  made.graph.nodes = columns * rows;
  for (int n = 0; n < made.graph.nodes; ++n) {
    Rigid3 pose;
    pose.rotation = rotation_exp(Vector3d(0, 0, random.uniform(-3.1, 3.1)));
    pose.translation = {4.0 * (n % columns) + random.uniform(-1, 1),
                        4.0 * (n / columns) + random.uniform(-1, 1), random.uniform(-0.2, 0.2)};
    made.world_from_node.push_back(pose);
  }
  std::vector<std::pair<int, int>> pairs;
  for (int n = 0; n < made.graph.nodes; ++n) {
    std::vector<std::pair<double, int>> near;
    for (int other = 0; other < made.graph.nodes; ++other) {
      if (other == n) continue;
      near.emplace_back((made.world_from_node[static_cast<std::size_t>(n)].translation -
                         made.world_from_node[static_cast<std::size_t>(other)].translation)
                            .norm(),
                        other);
    }
    std::sort(near.begin(), near.end());
    for (std::size_t k = 0; k < std::min(partners, near.size()); ++k)
      pairs.emplace_back(std::max(n, near[k].second), std::min(n, near[k].second));
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  for (const auto& [source, target] : pairs) {
    const bool wrong = random.uniform() < false_share;
    const Rigid3 truth = inverse(made.world_from_node[static_cast<std::size_t>(target)]) *
                         made.world_from_node[static_cast<std::size_t>(source)];
    const double agreeing = random.uniform(5.0, 30.0);
    GraphLink link;
    link.source = source;
    link.target = target;
    link.poses = {measured_pose(wrong ? random_pose(random, 8.0) : truth, agreeing, random)};
    made.graph.links.push_back(link);
    made.is_false.push_back(wrong);
  }
  return made;
}

}  // namespace limen
