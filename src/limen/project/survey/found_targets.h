// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "limen/extract/targets/found_target.h"
#include "limen/project/inputs/project_options.h"

namespace limen {

/// The targets that were found in a scan, in its file's coordinates.
struct TargetsOfScan {
  std::string scan;
  std::vector<FoundTarget> targets;
};

/// What was found, as a table for --targets, and in words.
struct TargetTable {
  std::string text;
  std::string words;
};

/// Names the targets of each scan by the distances between them: as control and check points where there are
/// such files, else T1, T2 and so on where several scans see them, one scan joining the next. Those that one
/// scan alone sees are called unknown_1, unknown_2 and so on.
TargetTable table_of_targets(const std::vector<TargetsOfScan>& scans, const ProjectInputs& inputs);

}  // namespace limen
