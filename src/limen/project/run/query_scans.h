// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/project/graph/pose_query.h"
#include "limen/project/run/scan_cache.h"
#include "limen/project/state/project_node.h"
#include "limen/register/register_options.h"

namespace limen {

/// Asks pairs of static scans; of others, and where two do not meet, nothing is answered. Keeps references.
PoseQuery query_of_scans(const std::vector<ProjectNode>& nodes, const RegisterOptions& options,
                         ScanCache& cache);

}  // namespace limen
