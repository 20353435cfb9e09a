// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/cli/terminal/command.h"

namespace limen {

/// `limen planes SCAN -o FILE.json`: planes of a scan and their outlines.
void add_planes_command(CommandLine& app, Session& session);

}  // namespace limen
