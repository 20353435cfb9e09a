// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/cli/terminal/command.h"

namespace limen {

/// `limen transform RESULT CLOUD OUT`: the cloud in the target's frame.
void add_transform_command(CommandLine& app, Session& session);

}  // namespace limen
