// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limen/model/bim_model.h"

namespace limen {

/// The area in which the closed surface made of `faces` meets the plane of `frame`, in its 2-D coordinates.
/// Gaps in the surface up to `tolerance_m` are bridged; what does not close is left out.
std::vector<Polygon> cross_section(const std::vector<const BimFace*>& faces, const PlaneFrame& frame,
                                   double tolerance_m = 0.002);

/// Whether a laser is stopped there today as on the day the model was drawn: walls, slabs, roofs, columns,
/// beams, stairs, coverings, terrain. Not: panes, leaves, furniture, railings, and elements of no known kind,
/// unless the file knows no kinds at all.
class BuiltElements {
 public:
  explicit BuiltElements(const BimModel& model);
  bool operator()(const BimElement& element) const;

 private:
  bool no_kinds_;
};

/// The surface of a model's built elements as far as it borders on air: faces less what other elements stand
/// against or penetrate them, flush faces of neighbouring elements made one. Each polygon has one part and
/// may have holes; its normal points into the air; `oriented` is true, `inliers` 0.
///
/// How: every face is cut by the cross-sections of the elements around it with a plane just before the face.
/// So neither end faces of walls under ceilings nor floors under walls remain.
struct ModelSurface {
  std::vector<PlanarPolygon> polygons;  ///< largest first
  std::vector<std::int32_t> elements;   ///< of each polygon: the element that gives most of it
};
/// Throws Error where the model cannot be a building in metres (require_plausible_size()).
ModelSurface visible_surface(const BimModel& model);

}  // namespace limen
