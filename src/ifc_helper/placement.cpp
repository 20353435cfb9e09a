// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "ifc_helper/placement.h"

#include <optional>
#include <vector>

#include <ifcpp/IFC4/include/IfcAxis2Placement2D.h>
#include <ifcpp/IFC4/include/IfcAxis2Placement3D.h>
#include <ifcpp/IFC4/include/IfcCartesianPoint.h>
#include <ifcpp/IFC4/include/IfcCartesianTransformationOperator2D.h>
#include <ifcpp/IFC4/include/IfcCartesianTransformationOperator2DnonUniform.h>
#include <ifcpp/IFC4/include/IfcCartesianTransformationOperator3D.h>
#include <ifcpp/IFC4/include/IfcCartesianTransformationOperator3DnonUniform.h>
#include <ifcpp/IFC4/include/IfcDirection.h>
#include <ifcpp/IFC4/include/IfcLengthMeasure.h>
#include <ifcpp/IFC4/include/IfcLocalPlacement.h>
#include <ifcpp/IFC4/include/IfcReal.h>

namespace limen::ifc {
namespace {

using Eigen::Vector3d;

/// Up to three numbers; missing ones are 0.
template <typename Measure>
Vector3d vector_of(const std::vector<std::shared_ptr<Measure>>& values) {
  Vector3d x = Vector3d::Zero();
  for (std::size_t k = 0; k < values.size() && k < 3; ++k) {
    if (values[k]) x[static_cast<Eigen::Index>(k)] = values[k]->m_value;
  }
  return x;
}

Vector3d point_of(const std::shared_ptr<IfcCartesianPoint>& point, double metres_per_unit) {
  return point ? Vector3d(metres_per_unit * vector_of(point->m_Coordinates)) : Vector3d::Zero();
}

std::optional<Vector3d> direction_of(const std::shared_ptr<IfcDirection>& direction) {
  if (!direction) return {};
  const Vector3d x = vector_of(direction->m_DirectionRatios);
  if (!(x.norm() > 1e-12)) return {};
  return x.normalized();
}

/// IfcBuildAxes: z given, x as near `wanted_x` as can be.
Eigen::Matrix3d axes(const Vector3d& z, Vector3d wanted_x) {
  if (wanted_x.cross(z).norm() < 1e-9)
    wanted_x = std::abs(z.x()) > 0.5 ? Vector3d::UnitY() : Vector3d::UnitX();
  Eigen::Matrix3d result;
  result.col(2) = z;
  result.col(0) = (wanted_x - wanted_x.dot(z) * z).normalized();
  result.col(1) = z.cross(Vector3d(result.col(0)));
  return result;
}

Affine3d affine(const Eigen::Matrix3d& linear, const Vector3d& origin) {
  Affine3d result = Affine3d::Identity();
  result.linear() = linear;
  result.translation() = origin;
  return result;
}

/// IfcBaseAxis: given axes are kept, missing ones completed.
Eigen::Matrix3d base_axes(const IfcCartesianTransformationOperator& target,
                          const std::optional<Vector3d>& axis3) {
  const Vector3d z = axis3.value_or(Vector3d::UnitZ());
  const Eigen::Matrix3d completed = axes(z, direction_of(target.m_Axis1).value_or(Vector3d::UnitX()));
  Eigen::Matrix3d result = completed;
  const std::optional<Vector3d> y = direction_of(target.m_Axis2);
  // A second axis may turn the frame into a mirrored one.
  if (y && y->dot(Vector3d(completed.col(1))) < 0.0) result.col(1) = -completed.col(1);
  return result;
}

}  // namespace

Affine3d frame_of(const IfcPlacement* placement, double metres_per_unit) {
  if (placement == nullptr) return Affine3d::Identity();
  const Vector3d origin = point_of(placement->m_Location, metres_per_unit);
  if (const auto* in_space = dynamic_cast<const IfcAxis2Placement3D*>(placement)) {
    const Vector3d z = direction_of(in_space->m_Axis).value_or(Vector3d::UnitZ());
    return affine(axes(z, direction_of(in_space->m_RefDirection).value_or(Vector3d::UnitX())), origin);
  }
  if (const auto* in_plane = dynamic_cast<const IfcAxis2Placement2D*>(placement)) {
    const Vector3d x = direction_of(in_plane->m_RefDirection).value_or(Vector3d::UnitX());
    return affine(axes(Vector3d::UnitZ(), x), origin);
  }
  return affine(Eigen::Matrix3d::Identity(), origin);
}

Affine3d world_frame_of(const std::shared_ptr<IfcObjectPlacement>& placement, double metres_per_unit) {
  constexpr int kLongestChain = 100;  // a circle of placements ends here
  Affine3d world_from_local = Affine3d::Identity();
  std::shared_ptr<IfcObjectPlacement> current = placement;
  for (int step = 0; step < kLongestChain && current; ++step) {
    const auto local = std::dynamic_pointer_cast<IfcLocalPlacement>(current);
    if (!local) break;
    const auto relative = std::dynamic_pointer_cast<IfcPlacement>(local->m_RelativePlacement);
    world_from_local = frame_of(relative.get(), metres_per_unit) * world_from_local;
    current = local->m_PlacementRelTo;
  }
  return world_from_local;
}

Affine3d frame_of(const IfcCartesianTransformationOperator* target, double metres_per_unit) {
  if (target == nullptr) return Affine3d::Identity();
  std::optional<Vector3d> axis3;
  const double scale = target->m_Scale ? target->m_Scale->m_value : 1.0;
  Vector3d scales = Vector3d::Constant(scale);
  if (const auto* in_space = dynamic_cast<const IfcCartesianTransformationOperator3D*>(target))
    axis3 = direction_of(in_space->m_Axis3);
  if (const auto* uneven = dynamic_cast<const IfcCartesianTransformationOperator3DnonUniform*>(target)) {
    if (uneven->m_Scale2) scales.y() = uneven->m_Scale2->m_value;
    if (uneven->m_Scale3) scales.z() = uneven->m_Scale3->m_value;
  }
  if (const auto* uneven = dynamic_cast<const IfcCartesianTransformationOperator2DnonUniform*>(target)) {
    if (uneven->m_Scale2) scales.y() = uneven->m_Scale2->m_value;
  }
  return affine(base_axes(*target, axis3) * scales.asDiagonal(),
                point_of(target->m_LocalOrigin, metres_per_unit));
}

}  // namespace limen::ifc
