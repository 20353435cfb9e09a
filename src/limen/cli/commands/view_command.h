// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/cli/terminal/command.h"

namespace limen {

/// `limen view FILE... -o view.html`: a page to look at clouds and models.
void add_view_command(CommandLine& app, Session& session);

}  // namespace limen
