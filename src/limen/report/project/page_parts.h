// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "limen/project/project_pictures.h"
#include "limen/project/result/project_result.h"
#include "limen/report/html/language.h"

namespace limen {

/// The script elements that hold a project for the page's own script: all scans with their points, outlines
/// and places, the links between them with what agrees, and the floors. `pictures`: of each scan of the
/// result.
std::string project_scene(const ProjectResult& result, std::vector<ProjectPicture> pictures,
                          Language language = Language::english);

/// Drawings (SVG) of the project's component: a plan of each floor and a section from the front and from the
/// side, each with walls or slabs, stations, links and surveyed points; ellipses are 100 times as large as
/// the deviations. `on_map`: the frame's y axis points north, and plans say where that is.
std::string project_plan(const ProjectResult& result, bool on_map = false);

/// How the mobile passes drifted: for each that was bent a drawing (SVG) of its correction along the way,
/// with two standard deviations; for others why they were not. Empty where there are no passes.
std::string pass_charts(const ProjectResult& result);

}  // namespace limen
