// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/cli/terminal/command.h"

namespace limen {

/// `limen transform PROJECT -o OUT`: every scan that is in a project's frame there, each in a file of its
/// name in a folder, or all in one file. A command of its own, hidden, since it takes other words than
/// `transform`; asked_project_move() tells which of the two is meant.
void add_transform_project_command(CommandLine& app, Session& session);

/// Whether the words after the program's name are `transform` with an option -o, which only a project has, or
/// with a project.json alone.
bool asked_project_move(int argc, char** argv);

/// `limen info FILE`: what a scan file holds and what limen makes of it.
void add_info_command(CommandLine& app, Session& session);
/// `limen planes SCAN -o FILE.json`: planes of a scan and their outlines.
void add_planes_command(CommandLine& app, Session& session);
/// `limen openings SCAN -o FILE.json`: windows and doors of a scan.
void add_openings_command(CommandLine& app, Session& session);
/// `limen segments SCAN -o FILE.json`: the 3-D line segments of a scan.
void add_segments_command(CommandLine& app, Session& session);
/// `limen register SOURCE TARGET -o DIR`: the pose of one scan in the other.
void add_register_command(CommandLine& app, Session& session);
/// `limen project`: any number of scans in one frame.
void add_project_command(CommandLine& app, Session& session);
/// `limen transform RESULT CLOUD OUT`: the cloud in the target's frame.
void add_transform_command(CommandLine& app, Session& session);
/// `limen thin CLOUD OUT`: fewer points, evenly spread, of a file of any size.
void add_thin_command(CommandLine& app, Session& session);
/// `limen view FILE... -o view.html`: a page to look at clouds and models.
void add_view_command(CommandLine& app, Session& session);
/// `limen serve DIR`: a page on this machine to drop files on, to start work and to look at what came of it.
void add_serve_command(CommandLine& app, Session& session);
/// `limen evaluate RESULT TRUTH`: how far a pose is from the true one.
void add_evaluate_command(CommandLine& app, Session& session);
/// `limen deviation SCAN MODEL --result RESULT -o DIR`: what was built differently from its model.
void add_deviation_command(CommandLine& app, Session& session);
/// `limen simulate NAME -o DIR`: scans of a made-up building, and the truth about them.
void add_simulate_command(CommandLine& app, Session& session);
/// `limen schema result` and others: the JSON Schema of a file that limen writes.
void add_schema_command(CommandLine& app, Session& session);
/// limen completion SHELL: prints the completion script; and, not listed in the help, limen man: prints the
/// manual page. Both are made from the commands that `app` has when they run.
void add_completion_command(CommandLine& app, Session& session);

}  // namespace limen
