// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "limen/cli/terminal/command_line.h"
#include "limen/report/html/html_cover.h"

namespace limen {

/// --title, --project, --operator and --date: what the one who hands a report on writes on it.
void add_cover_options(CommandLine& command, ReportCover& cover);

}  // namespace limen
