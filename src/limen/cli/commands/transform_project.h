// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/cli/terminal/command.h"

namespace limen {

/// `limen transform PROJECT -o OUT`: every scan that is in a project's frame there, each in a file of its
/// name in a folder, or all in one file. A command of its own, hidden, since it takes other words than
/// `transform`; asked_project_move() tells which of the two is meant.
void add_transform_project_command(CommandLine& app, Session& session);

/// Its name.
inline constexpr const char* kProjectMove = "transform-project";

/// Whether the words after the program's name are `transform` with an option -o: only a project has one.
bool asked_project_move(int argc, char** argv);

}  // namespace limen
