// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/base/angles.h"
#include "limen/geometry/polygon.h"
#include "limen/geometry/segment.h"

namespace limen {

struct ModelEdgeOptions {
  double min_length_m = 0.1;             ///< shorter edges are left out, > 0
  double min_angle_rad = radians(25.0);  ///< faces that meet at less make no edge: a curved wall's facets
  double same_line_m = 0.003;            ///< edges of two faces within this are one, > 0
};

/// The sharp edges of a visible surface (2023, section VI: future work there): the outlines of its polygons,
/// each line once, without the seams between faces that go on smoothly.
std::vector<Segment> sharp_edges(const std::vector<PlanarPolygon>& surface,
                                 const ModelEdgeOptions& options = {});

}  // namespace limen
