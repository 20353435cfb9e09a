// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/project/graph/pose_query.h"
#include "limen/project/inputs/project_options.h"
#include "limen/project/result/project_result.h"
#include "limen/project/state/project_node.h"
#include "limen/project/state/words.h"

namespace limen {

/// The frame, the states and the words (`bounds`: what a scan reported as registered, or as probable, may be
/// wrong with): everything of `result` but its scans' files. `query`: what scans say of places that no pair
/// proposed. Throws Error where a file of the survey is no good.
void assemble(const std::vector<ProjectNode>& nodes, const std::vector<TriedPair>& pairs,
              const ProjectInputs& inputs, const UserWords& words, const VerdictOptions& bounds,
              const PoseQuery& query, ProjectResult& result);

}  // namespace limen
