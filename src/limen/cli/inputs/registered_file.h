// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "limen/cli/terminal/command.h"
#include "limen/report/pose_file.h"
#include "limen/report/project/read_project.h"

namespace limen {

/// Tells on standard error that the pose which a file gives as its answer is less than registered. Of a
/// probable one that is a warning with its probability, shown also where quiet. `path` names the file.
void warn_of_doubt(const PoseFile& file, const std::string& path, const Session& session);

/// Tells on standard error where a pose was found for one scan of a file and is applied to another one of it:
/// that is right only where the file's own poses join them. Both as a user names scans.
void note_other_scan(const std::string& registered, const std::string& given, const Session& session);

/// The unit in which a file is read again that a result is about. `stated`: what the result says of its
/// numbers. Nothing for a model in metres: an IFC file says its own unit, and a mesh has none other.
std::optional<double> unit_to_read(const std::string& path, std::optional<double> stated);

/// A place in a project holds for the bytes that were registered. Throws Error where the scan's file cannot
/// be read, or, but for `force`, holds other bytes; `project` names the project.json in messages.
void require_registered_file(const ProjectEntry& entry, const std::string& project, bool force);

}  // namespace limen
