// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "limen/bim/solid/polygon_mesh.h"
#include "limen/bim/solid/solid.h"
#include "limen/model/bim_model.h"

namespace limen {

/// When pieces of surface count as one plane.
constexpr double kFlatFaceM = 5e-4;    ///< corners lie within this of their face's plane
constexpr double kFlatFaceRad = 2e-3;  ///< normals agree within this; curved surfaces stay many faces

/// The flat faces of one element: its mesh is welded and oriented, pieces in one plane that touch are merged
/// into maximal faces with holes. Points are about the model's local origin; the order depends on the mesh
/// alone. A face takes `element` for its own.
std::vector<BimFace> flat_faces(const PolygonMesh& mesh, std::int32_t element);

/// The faces that fill `areas` of a plane, slivers left out.
std::vector<BimFace> faces_in_plane(const Plane& plane, const PlaneFrame& frame,
                                    const std::vector<Polygon>& areas);

/// The surface of one element.
struct SolidFaces {
  std::vector<BimFace> faces;
  std::size_t open_cutters = 0;  ///< solids that are not closed and so could not be operated with
};

/// The flat faces of an element that consists of `shapes`, each less all of `cutters` (its openings). Meshes
/// are welded and oriented first. Operations are carried out face by face in two dimensions: a face of any of
/// the meshes stays where the whole is solid behind it and empty before it, and is turned round where it is
/// the other way about (the sides of an opening). Faces that touch in one plane are merged.
/// The faces' `element` is -1.
SolidFaces solid_faces(const std::vector<Solid>& shapes, const std::vector<const Solid*>& cutters = {});

/// The faces with those merged that lie in one plane, look the same way and touch.
std::vector<BimFace> joined_faces(std::vector<BimFace> faces);

/// All meshes of a solid that adds them only, as one; operations are passed over.
PolygonMesh all_meshes(const Solid& solid);

}  // namespace limen
