// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/cli/terminal/command.h"

namespace limen {

/// `limen simulate NAME -o DIR`: scans of a made-up building, and the truth about them.
void add_simulate_command(CommandLine& app, Session& session);

}  // namespace limen
