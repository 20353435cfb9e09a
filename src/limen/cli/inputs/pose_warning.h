// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "limen/cli/terminal/command.h"
#include "limen/report/pose_file.h"

namespace limen {

/// Tells on standard error that the pose which a file gives as its answer is less than registered. Of a
/// probable one that is a warning with its probability, shown also where quiet. `path` names the file.
void warn_of_doubt(const PoseFile& file, const std::string& path, const Session& session);

}  // namespace limen
