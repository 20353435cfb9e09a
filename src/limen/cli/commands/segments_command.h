// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/cli/terminal/command.h"

namespace limen {

/// `limen segments SCAN -o FILE.json`: the 3-D line segments of a scan.
void add_segments_command(CommandLine& app, Session& session);

}  // namespace limen
