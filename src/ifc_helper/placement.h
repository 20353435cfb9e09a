// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <Eigen/Geometry>
#include <ifcpp/model/GlobalDefines.h>

class IfcAxis2Placement;
class IfcCartesianTransformationOperator;
class IfcObjectPlacement;
class IfcPlacement;

namespace limen::ifc {

using Eigen::Affine3d;

/// The placement's frame in its parent's, lengths multiplied by `metres_per_unit`.
Affine3d frame_of(const IfcPlacement* placement, double metres_per_unit);

/// The chain of local placements up to the world. Grid placements count as none.
Affine3d world_frame_of(const std::shared_ptr<IfcObjectPlacement>& placement, double metres_per_unit);

/// A mapping's target: rotation, scale (also different ones along the axes), origin.
Affine3d frame_of(const IfcCartesianTransformationOperator* target, double metres_per_unit);

}  // namespace limen::ifc
