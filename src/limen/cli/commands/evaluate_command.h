// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/cli/terminal/command.h"

namespace limen {

/// `limen evaluate RESULT TRUTH`: how far a pose is from the true one.
void add_evaluate_command(CommandLine& app, Session& session);

}  // namespace limen
