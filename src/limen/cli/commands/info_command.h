// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/cli/terminal/command.h"

namespace limen {

/// `limen info FILE`: what a scan file holds and what limen makes of it.
void add_info_command(CommandLine& app, Session& session);

}  // namespace limen
