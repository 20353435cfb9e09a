// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "limen/project/result/project_result.h"

namespace limen {

/// Drawings (SVG) of the project's component: a plan of each floor and a section from the front and from the
/// side, each with walls or slabs, stations, links and surveyed points; ellipses are 100 times as large as
/// the deviations. `on_map`: the frame's y axis points north, and plans say where that is.
std::string project_plan(const ProjectResult& result, bool on_map = false);

}  // namespace limen
