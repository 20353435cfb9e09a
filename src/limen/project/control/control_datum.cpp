// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/control/control_datum.h"

#include <optional>

#include "limen/geometry/linear.h"

namespace limen {
namespace {

/// Where members see a point, each sight as it is known with its node's place; empty: none does.
std::optional<PointPair> pair_of(const MarkedPoint& point, const FramedNodes& nodes) {
  Matrix3d weights = Matrix3d::Zero();
  Vector3d sum = Vector3d::Zero();
  MarkedPoint seen;
  for (const PointSight& sight : point.sights) {
    if (nodes.member[static_cast<std::size_t>(sight.node)]) seen.sights.push_back(sight);
  }
  if (seen.sights.empty()) return {};
  const PointTerms terms = point_terms(seen, nodes.frame_from_node);
  for (std::size_t k = 0; k < seen.sights.size(); ++k) {
    const Matrix6d& of_node = nodes.covariance[static_cast<std::size_t>(seen.sights[k].node)];
    const Matrix3d covariance =
        inverse_of(terms.weight[k]) + terms.by_pose[k] * of_node * terms.by_pose[k].transpose();
    const Matrix3d weight = inverse_of(covariance);
    weights += weight;
    sum += weight * terms.place[k];
  }
  const Matrix3d covariance = inverse_of(weights);
  return PointPair{covariance * sum, covariance, point.known->x, point.known->covariance};
}

}  // namespace

ControlDatum control_datum(const std::vector<MarkedPoint>& points, const FramedNodes& nodes) {
  ControlDatum datum;
  std::vector<PointPair> pairs;
  for (std::size_t p = 0; p < points.size(); ++p) {
    if (!points[p].is_known()) continue;
    const std::optional<PointPair> pair = pair_of(points[p], nodes);
    if (!pair) continue;
    pairs.push_back(*pair);
    datum.points.push_back(p);
  }
  datum.fit = fit_points(pairs);
  return datum;
}

}  // namespace limen
