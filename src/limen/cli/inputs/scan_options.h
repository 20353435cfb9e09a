// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "limen/cli/terminal/command.h"
#include "limen/io/cloud/read_scan.h"
#include "limen/io/trajectory/read_trajectory.h"
#include "limen/model/bim_model.h"
#include "limen/register/prepare/prepare_scan.h"
#include "limen/report/json/result_json.h"

namespace limen {

/// The names in a list: one a line, relative to the list's folder, without blanks around; empty lines and
/// those that begin with # do not count, nor does a byte order mark. Throws Error where it is no list.
std::vector<std::string> names_in_list(const std::string& path);

/// "x,y,z" as three numbers. Throws Error that names `option`.
Vector3d parse_point(const std::string& text, const std::string& option);

/// Adds --gravity up|unknown, and auto where that is offered: whether the z axis of the files points up.
void add_gravity_option(CommandLine& command, std::string& gravity, bool with_auto = false);

/// Adds --repeats unknown|none: what is known of rooms built alike.
void add_repeats_option(CommandLine& command, std::string& repeats);

/// What the user says of how scans are to be read, beside their origin.
struct ReadingChoice {
  std::string memory;      ///< "1G" or empty
  std::string units;       ///< "mm" or empty: what the file says, else metres
  std::string trajectory;  ///< a file or empty
  std::string columns;     ///< "time,x,y,z" or empty
  std::string utm_zone = "auto";
  std::string lever_arm;  ///< "x,y,z" or empty
  double time_offset_s = 0.0;
  std::string side;  ///< what is before the names of these options: "source-", or nothing
};

/// "500M", "2.5G" or a number of bytes; 0 for an empty text. Throws Error for anything else.
std::uint64_t parse_memory(const std::string& text);
/// Adds --memory.
void add_memory_option(CommandLine& command, std::string& memory);
/// Adds --trajectory and what belongs to it; `side` is before the name ("source-") or is empty.
void add_trajectory_options(CommandLine& command, ReadingChoice& choice, const std::string& side = "");
/// Adds --units; `side` is before the name ("source-") or is empty.
void add_units_option(CommandLine& command, std::string& units, const std::string& side = "");
/// Metres per unit of a name that was given; nothing for an empty text.
std::optional<double> metres_per_unit_of(const std::string& units);
/// How a trajectory is to be read.
TrajectoryOptions trajectory_options(const ReadingChoice& choice);
/// Throws Error where an option describes a trajectory; for a choice that names none.
void require_trajectory(const ReadingChoice& choice);
/// What read_options() gave, with the choice; reads the trajectory.
ReadOptions with_choice(ReadOptions options, const ReadingChoice& choice);

/// What the user said of a scan: `origin` "x,y,z" or empty (`option` names it in messages), `gravity`
/// "auto", "up" or "unknown".
ReadOptions read_options(const std::string& origin, const std::string& option, const std::string& gravity);

/// Metres per unit of the numbers of a scan or a model: as the user says, else as the file, else 1.
double unit_of_input(const std::string& path, std::optional<double> metres_per_unit);

/// The one scan of a file, with what it was there.
struct InputScan {
  Scan scan;
  double metres_per_unit = 1.0;                ///< of the file's numbers
  Vector3d offset_applied = Vector3d::Zero();  ///< that the file names in a comment; metres
};
/// Reads it, and notes where it was thinned or cut, what unit its numbers have where they are not metres,
/// which offset was added, where it is as large as no building, and where it has too few points.
/// `units_option`: of the command, by which the unit of this file is named.
InputScan read_input_scan(const std::string& path, const ReadOptions& options, const Session& session,
                          const std::string& units_option);

/// Reads a building model and notes its warnings; `metres_per_unit`: of a mesh, where the user says so, and
/// `units_option`: by which (empty: there is none). Throws Error where it cannot be a building in metres.
BimModel read_model_input(const std::string& path, const Session& session,
                          std::optional<double> metres_per_unit = {}, const std::string& units_option = {});

/// The offset that a mesh in a PLY file names in a comment, and that is in the model's coordinates; metres.
Vector3d offset_of_model(const std::string& path, const BimModel& model);

/// Adds --alternative N: which pose of a result is meant, 0 being its answer.
void add_alternative_option(CommandLine& command, int& alternative);

/// "up", "unknown", else automatic.
Gravity gravity_of(const std::string& name);

/// Enters where the scanner of a scan was found to have stood; notes a place that was said and cannot be
/// right.
void note_place(InputSummary& summary, const ScannerPlace& place, const Session& session);

/// Throws Error where `output` is the file `input`: a result never replaces what it was made from.
void refuse_same_file(const std::string& output, const std::string& input);
/// The same of files that a command writes into a folder under names of its own.
void refuse_same_files(const std::filesystem::path& folder, const std::vector<const char*>& names,
                       const std::vector<std::string>& inputs);

}  // namespace limen
