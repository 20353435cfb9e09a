// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "limen/model/features.h"
#include "limen/model/scan.h"
#include "limen/project/project.h"

namespace limen {

/// What the store holds for a report to draw of one scan or model.
struct ProjectPicture {
  Scan points;        ///< thinned; none of a model
  Features features;  ///< planes and openings; none where there are very many scans
};

/// Of each scan of the result; empty ones of what could not be read. `most_points`: of all together.
std::vector<ProjectPicture> project_pictures(const std::filesystem::path& folder,
                                             const ProjectOptions& options, const ProjectResult& result,
                                             std::size_t most_points);

}  // namespace limen
