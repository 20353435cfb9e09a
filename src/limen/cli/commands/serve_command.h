// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/cli/terminal/command.h"

namespace limen {

/// `limen serve DIR`: a page on this machine to drop files on, to start work and to look at what came of it.
void add_serve_command(CommandLine& app, Session& session);

}  // namespace limen
