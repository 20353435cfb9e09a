// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/bim/solid/polygon_mesh.h"
#include "limen/model/bim_model.h"

namespace limen {

/// When pieces of surface count as one plane.
struct FlatFaceOptions {
  double plane_m = 5e-4;        ///< corners lie within this of their face's plane, > 0
  double angle_rad = 2e-3;      ///< normals agree within this, > 0; curved surfaces stay many faces
  double least_width_m = 1e-4;  ///< narrower faces and holes are left out, >= 0

  void check() const;
};

/// The flat faces of one element: its mesh is welded and oriented, pieces in one plane that touch are merged
/// into maximal faces with holes. Points are about the model's local origin; the order depends on the mesh
/// alone. A face takes `element` for its own.
std::vector<BimFace> flat_faces(const PolygonMesh& mesh, std::int32_t element,
                                const FlatFaceOptions& options = {});

/// The faces that fill `areas` of a plane, slivers left out.
std::vector<BimFace> faces_in_plane(const Plane& plane, const PlaneFrame& frame,
                                    const std::vector<Polygon>& areas, const FlatFaceOptions& options = {});

}  // namespace limen
