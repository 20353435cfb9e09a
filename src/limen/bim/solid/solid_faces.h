// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "limen/bim/solid/flat_faces.h"
#include "limen/bim/solid/solid.h"

namespace limen {

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
SolidFaces solid_faces(const std::vector<Solid>& shapes, const std::vector<const Solid*>& cutters = {},
                       const FlatFaceOptions& options = {});

/// The faces with those merged that lie in one plane, look the same way and touch.
std::vector<BimFace> joined_faces(std::vector<BimFace> faces, const FlatFaceOptions& options = {});

/// All meshes of a solid that adds them only, as one; operations are passed over.
PolygonMesh all_meshes(const Solid& solid);

}  // namespace limen
