// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "limen/report/project/read_project.h"

namespace limen {

/// A place in a project holds for the bytes that were registered. Throws Error where the scan's file cannot
/// be read, or, but for `force`, holds other bytes; `project` names the project.json in messages.
void require_registered_file(const ProjectEntry& entry, const std::string& project, bool force);

}  // namespace limen
