// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "limen/project/project_result.h"

namespace limen {

/// The project's component from above, one drawing (SVG) per floor: walls, stations with their numbers in the
/// table of scans, links between them. Empty where no station stands in the frame.
std::string project_plan(const ProjectResult& result);

}  // namespace limen
