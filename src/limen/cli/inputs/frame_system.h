// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "limen/cli/terminal/command.h"
#include "limen/io/crs/coordinate_system.h"
#include "limen/project/result/project_result.h"
#include "limen/report/project/project_json.h"

namespace limen {

/// Adds --crs.
void add_crs_option(CommandLine& command, std::string& text);

/// What --crs names: EPSG:NUMBER, well-known text, PROJJSON, or a file that holds one of them (.prj). Not
/// known where the text is empty. Throws Error for what is none.
CoordinateSystem chosen_system(const std::string& text);

/// The coordinate system that a point file states; not known where it states none or cannot be
/// opened.
CoordinateSystem system_of_file(const std::string& path);

/// The system of a project's frame: what the user says, else that of the file whose world coordinates the
/// frame has. Files that say another one are named in `notes`.
FrameSystem frame_system(const ProjectResult& result, const CoordinateSystem& chosen,
                         std::vector<std::string>& notes);

}  // namespace limen
