// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "limen/geometry/rigid.h"

namespace limen {

/// Where a node saw a marked point.
struct PointSight {
  int node = -1;
  Vector3d x_in_node = Vector3d::Zero();
  Matrix3d covariance = Matrix3d::Identity();  ///< node's axes, m^2
  double strayed_m = 0.0;  ///< of a mobile pass: from its pose, along each axis, one standard deviation
  std::optional<double> place = std::nullopt;  ///< along the way of a pass, in knots
  std::size_t number = 0;                      ///< among the sights of its point, as they were given

  /// Node's axes, m^2.
  [[nodiscard]] Matrix3d whole_covariance() const {
    return covariance + strayed_m * strayed_m * Matrix3d::Identity();
  }
};

/// Coordinates that are an observation: never fixed.
struct KnownPlace {
  Vector3d x = Vector3d::Zero();  ///< frame of the adjustment
  Matrix3d covariance = Matrix3d::Identity();
};

/// A marked point, its own three coordinates unknown.
struct MarkedPoint {
  std::vector<PointSight> sights;
  std::optional<KnownPlace> known;
  bool enters = true;  ///< otherwise the poses tell where it is, and it tells them nothing
  /// Otherwise its sights tie nodes to one another, and its coordinates tell nothing.
  bool known_enters = true;

  [[nodiscard]] bool is_known() const { return known.has_value() && enters && known_enters; }
};

/// The sights of a point as the adjustment needs them.
struct PointTerms {
  std::vector<Matrix3d> weight;                      ///< of each sight, frame axes
  std::vector<Eigen::Matrix<double, 3, 6>> by_pose;  ///< of each sight's place, by a small motion of its node
  std::vector<Vector3d> place;                       ///< of each sight, frame
  Matrix3d own = Matrix3d::Zero();                   ///< normal matrix of the point: sights and coordinates
  Vector3d x = Vector3d::Zero();  ///< what best explains the sights and coordinates, poses held
};
PointTerms point_terms(const MarkedPoint& point, const std::vector<Rigid3>& frame_from_node);

}  // namespace limen
