// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "limen/project/project_pictures.h"
#include "limen/report/html/language.h"

namespace limen {

/// The script elements that hold a project for the page's own script: all scans with their points, outlines
/// and places, the links between them with what agrees, and the floors. `pictures`: of each scan of the
/// result.
std::string project_scene(const ProjectResult& result, std::vector<ProjectPicture> pictures,
                          Language language = Language::english);

}  // namespace limen
