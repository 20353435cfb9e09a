// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <numeric>
#include <vector>

#include "support/synthetic_graph.h"

#include "limen/geometry/random_vectors.h"
#include "limen/project/adjust/plane_adjustment.h"

namespace limen {

/// A building of stations whose links err, surveyed: targets that the stations nearest to them see, with the
/// coordinates of some of them in a frame of its own.
struct SyntheticSurvey {
  SyntheticGraph building;
  Rigid3 control_from_world;
  std::vector<MarkedPoint> points;     ///< coordinates about the origin of control; sights in the nodes' axes
  std::vector<Vector3d> x_in_control;  ///< the truth
};

inline Vector3d noise3(double sigma_m, RandomStream& random) {
  return sigma_m * normal_vector(random);
}

/// `places` in the world of the building; coordinates and sights err by `sigma_m`, every point is seen by
/// `seers` stations.
inline SyntheticSurvey synthetic_survey(const std::vector<Vector3d>& places, double sigma_m,
                                        std::size_t seers, std::uint64_t seed) {
  RandomStream random(seed, 11);
  SyntheticSurvey made;
  made.building = synthetic_graph(4, 3, 4, 0.0, seed);
  made.control_from_world.rotation = rotation_exp(Vector3d(0, 0, random.uniform(-3.1, 3.1)));
  made.control_from_world.translation = {random.uniform(-60, 60), random.uniform(-60, 60), 12.0};
  const Matrix3d covariance = sigma_m * sigma_m * Matrix3d::Identity();
  for (const Vector3d& place : places) {
    MarkedPoint point;
    made.x_in_control.push_back(made.control_from_world * place);
    point.known = KnownPlace{made.x_in_control.back() + noise3(sigma_m, random), covariance};
    std::vector<std::size_t> order(made.building.world_from_node.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return (made.building.world_from_node[a].translation - place).norm() <
             (made.building.world_from_node[b].translation - place).norm();
    });
    for (std::size_t k = 0; k < seers; ++k) {
      const Rigid3 node_from_world = inverse(made.building.world_from_node[order[k]]);
      point.sights.push_back(
          {static_cast<int>(order[k]), node_from_world * place + noise3(sigma_m, random), covariance});
    }
    made.points.push_back(point);
  }
  return made;
}

/// Corners of the building at floor and ceiling, and its middle: `count` of them, at most eight.
inline std::vector<Vector3d> corner_places(std::size_t count) {
  const std::vector<Vector3d> all = {{-1, -1, 0.3}, {13, -1, 2.6}, {13, 9, 0.4}, {-1, 9, 2.4},
                                     {6, 4, 2.7},   {6, -1, 1.0},  {6, 9, 1.2},  {-1, 4, 1.1}};
  return {all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count)};
}

}  // namespace limen
