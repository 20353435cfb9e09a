// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/cli/terminal/command.h"

namespace limen {

/// `limen deviation SCAN MODEL --result RESULT -o DIR`: what was built differently from its model.
void add_deviation_command(CommandLine& app, Session& session);

}  // namespace limen
