// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/adjust/survey_point.h"

#include "limen/geometry/linear.h"

namespace limen {

PointTerms point_terms(const MarkedPoint& point, const std::vector<Rigid3>& frame_from_node) {
  PointTerms terms;
  Vector3d right = Vector3d::Zero();
  for (const PointSight& sight : point.sights) {
    const Rigid3& node = frame_from_node[static_cast<std::size_t>(sight.node)];
    const Vector3d arm = node.rotation * sight.x_in_node;
    // A turn d about the node's origin moves the point by d x arm.
    Eigen::Matrix<double, 3, 6> by_pose;
    by_pose << 0, arm.z(), -arm.y(), 1, 0, 0,  //
        -arm.z(), 0, arm.x(), 0, 1, 0,         //
        arm.y(), -arm.x(), 0, 0, 0, 1;
    const Matrix3d weight =
        inverse_of(Matrix3d(node.rotation * sight.whole_covariance() * node.rotation.transpose()));
    const Vector3d place = node.translation + arm;
    terms.by_pose.push_back(by_pose);
    terms.weight.push_back(weight);
    terms.place.push_back(place);
    terms.own += weight;
    right += weight * place;
  }
  if (point.is_known()) {
    const Matrix3d weight = inverse_of(point.known->covariance);
    terms.own += weight;
    right += weight * point.known->x;
  }
  terms.x = inverse_of(terms.own) * right;
  return terms;
}

}  // namespace limen
