// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/cli/terminal/command.h"

namespace limen {

/// `limen schema result` and others: the JSON Schema of a file that limen writes.
void add_schema_command(CommandLine& app, Session& session);

}  // namespace limen
