// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/cli/terminal/command.h"

namespace limen {

/// `limen register SOURCE TARGET -o DIR`: the pose of one scan in the other.
void add_register_command(CommandLine& app, Session& session);

}  // namespace limen
