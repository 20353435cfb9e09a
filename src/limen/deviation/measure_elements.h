// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/deviation/coverage.h"
#include "limen/deviation/element_shift.h"
#include "limen/deviation/model_faces.h"

namespace limen {

/// What scans say of the faces of a model.
struct FaceEvidence {
  std::vector<FaceOffset> offsets;  ///< `points` 0: not known
  std::vector<FaceCoverage> coverage;
};

/// The elements of a model with their surface, before anything was seen of them.
std::vector<ElementDeviation> elements_of(const BimModel& model);

/// Gives every element its coverage, presence and shift; figures of its points it has already. Returns the
/// shift of all of them together.
ElementShift measure_elements(const BimModel& model, const ModelFaces& faces, const FaceEvidence& evidence,
                              const DeviationOptions& options, std::vector<ElementDeviation>& elements);

/// Lowest and highest coordinates of the faces.
struct FacesExtent {
  Vector3d low = Vector3d::Constant(1e300);
  Vector3d high = Vector3d::Constant(-1e300);
};
FacesExtent extent_of(const ModelFaces& faces);

}  // namespace limen
