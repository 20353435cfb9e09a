// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/deviation/element_shift.h"
#include "limen/deviation/model_faces.h"
#include "limen/deviation/point_faces.h"

namespace limen {

/// The signed distances of the points on each face, in the points' order.
std::vector<std::vector<float>> distances_by_face(const PointFaces& laid, std::size_t faces);

/// Where the surface before each face is, by one scan; `points` is 0 where they are too few.
std::vector<FaceOffset> face_offsets(const ModelFaces& faces, const PointFaces& laid,
                                     const std::vector<std::vector<float>>& distances_m,
                                     const DeviationOptions& options);

}  // namespace limen
