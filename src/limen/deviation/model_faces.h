// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limen/geometry/face_index.h"
#include "limen/model/bim_model.h"

namespace limen {

/// The faces of a model to which points are assigned.
struct ModelFaces {
  std::vector<FlatFace> faces;
  std::vector<std::int32_t> elements;  ///< of each face
  std::vector<char> panes;             ///< of each face: 1 where it may be glass in a door
};

/// All faces of the elements. Faces of elements that are no closed solids are there twice, once for either
/// side: which side of a sheet is the outer one nobody can say.
ModelFaces faces_of(const BimModel& model);

}  // namespace limen
