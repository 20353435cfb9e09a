// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "limen/project/project_result.h"

namespace limen {

/// report.html of a project: one page that needs nothing else. Questions first; a plan of each floor with
/// every station and its links, coloured and dashed by their state; tables of scans, links and loops.
std::string project_page(const ProjectResult& result);

}  // namespace limen
