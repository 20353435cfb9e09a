// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/bim/solid/polygon_mesh.h"
#include "limen/geometry/polygon.h"

namespace limen {

/// Which side of a plane is meant where a solid has a face in it.
enum class PlaneSide { before, behind };  ///< before: where the normal points to

/// The section of a closed, outwards oriented mesh with the plane of `frame` (normal u x v), in plane
/// coordinates. Where the mesh has corners within 0.1 mm of the plane, the section is taken 0.2 mm off it, on
/// the side asked for.
std::vector<Polygon> section(const PolygonMesh& mesh, const PlaneFrame& frame, PlaneSide side);

}  // namespace limen
