// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/cli/terminal/command.h"

namespace limen {

/// limen completion SHELL: prints the completion script; and, not listed in the help, limen man: prints the
/// manual page. Both are made from the commands that `app` has when they run.
void add_completion_command(CommandLine& app, Session& session);

}  // namespace limen
