// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/cli/terminal/command.h"

namespace limen {

/// `limen openings SCAN -o FILE.json`: windows and doors of a scan.
void add_openings_command(CommandLine& app, Session& session);

}  // namespace limen
