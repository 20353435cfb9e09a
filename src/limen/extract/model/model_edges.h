// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/geometry/polygon.h"
#include "limen/geometry/segment.h"

namespace limen {

/// The sharp edges of a visible surface (2023, section VI: future work there): the outlines of its polygons,
/// each line once, without the seams between faces that go on smoothly and without edges shorter
/// than `min_length_m`, more than 0.
std::vector<Segment> sharp_edges(const std::vector<PlanarPolygon>& surface, double min_length_m = 0.1);

}  // namespace limen
