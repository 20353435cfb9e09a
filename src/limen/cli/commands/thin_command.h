// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/cli/terminal/command.h"

namespace limen {

/// `limen thin CLOUD OUT`: fewer points, evenly spread, of a file of any size.
void add_thin_command(CommandLine& app, Session& session);

}  // namespace limen
