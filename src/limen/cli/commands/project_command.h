// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/cli/terminal/command.h"

namespace limen {

/// `limen project`: any number of scans in one frame.
void add_project_command(CommandLine& app, Session& session);

}  // namespace limen
