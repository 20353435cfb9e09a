// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "limen/project/project_pictures.h"
#include "limen/report/html/html_cover.h"

namespace limen {

/// Points of all scans that a page shows.
inline constexpr std::size_t kMostProjectPoints = 700'000;

/// report.html of a project: one page that needs nothing else. Questions first, with pictures of the scans;
/// all scans in space, with the links between them and each link alone; a plan of each floor and sections;
/// tables of scans, links and loops. `pictures`: of each scan of the result, or none: then no points are
/// shown. `cover`: what is written above and signed below. `on_map`: the frame is a map's, by its coordinate
/// system or by control points.
std::string project_page(const ProjectResult& result, std::vector<ProjectPicture> pictures = {},
                         bool on_map = false, const ReportCover& cover = {});

}  // namespace limen
