// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "limen/report/html/html_view.h"

namespace limen {

/// From where a section is looked at: plan from above, the other two level, along the building's walls.
enum class SectionSide { top, front, side };
const char* to_string(SectionSide side);

/// A section through both sides as an SVG picture of its own: points near the cut, the cut walls (target
/// whole lines, source dashed), scale bar and key. The same bytes for the same input.
std::string section_svg(const ReportScene& scene, const SceneView& view, SectionSide side);

/// Points where the plane normal . x = offset cuts a flat polygon, in pairs: pieces of a straight line.
std::vector<Segment> cut_polygon(const PlanarPolygon& polygon, const Plane& cut);

}  // namespace limen
