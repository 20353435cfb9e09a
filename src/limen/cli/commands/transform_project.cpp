// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "limen/base/atomic_file.h"
#include "limen/base/error.h"
#include "limen/base/length_unit.h"
#include "limen/cli/commands/commands.h"
#include "limen/cli/inputs/frame_system.h"
#include "limen/cli/inputs/project_trajectories.h"
#include "limen/cli/inputs/registered_file.h"
#include "limen/cli/inputs/scan_options.h"
#include "limen/files/mapped_file.h"
#include "limen/files/scan_in_file.h"
#include "limen/io/cloud/transform_cloud.h"
#include "limen/io/cloud/write_clouds.h"
#include "limen/io/las/laz/copc_writer.h"
#include "limen/report/json/json_values.h"
#include "limen/report/project/read_project.h"
#include "limen/report/summary/words.h"

namespace limen {
namespace {

namespace fs = std::filesystem;

/// What the user says of moving the scans of a project.
struct ProjectMoveOptions {
  std::string project;  ///< project.json
  std::string output;   ///< a folder, or with `merge` a file
  std::string ending;   ///< as --as has it: "e57", "copc", or empty: each as it is
  bool merge = false;   ///< all in one file
  bool force = false;   ///< also of files that are not those that were registered
  std::string crs;      ///< of the frame, where the user says it
  bool invert = false;  ///< of a pair alone, as the next
  int alternative = 0;
};

/// A scan that is written, and to where.
struct Move {
  ProjectEntry entry;
  bool several = false;  ///< its file holds others
  fs::path output;
};

/// Words of a pair's transform would be passed over, and a folder that is called like a file taken for one.
void check_words(const ProjectMoveOptions& options) {
  for (const auto& [given, name] :
       {std::pair(options.invert, "--invert"), std::pair(options.alternative != 0, "--alternative")}) {
    if (given)
      throw Error(fmt::format("{} does not apply to a project", name), options.project,
                  "leave it out: every scan has one pose in the frame");
  }
  if (has_cloud_ending(options.output) && !options.merge)
    throw Error("looks like a file name, but without --merge each scan is written to a file of its own",
                options.output, "add --merge to write one file, or give the name of a folder");
}

/// All scans, by file; those without a place are named.
std::vector<Move> moves_of(const std::vector<ProjectEntry>& entries, const Session& session) {
  std::map<std::string, int> in_file;
  for (const ProjectEntry& entry : entries) ++in_file[entry.file];
  std::vector<Move> moves;
  for (const ProjectEntry& entry : entries) {
    if (entry.model) continue;
    moves.push_back({entry, in_file[entry.file] > 1, {}});
    if (!entry.frame_from_scan)
      session.note(fmt::format("{}: {}, not written", scan_name(entry), entry.state));
    else if (entry.state == "probable")
      session.warn(fmt::format("{}: its pose is only probable; the probability that it is right is {}",
                               scan_name(entry), probability_words(1.0 - entry.doubt)));
    else if (entry.state != "registered")
      session.note(fmt::format("{}: its state is {}: check its pose", scan_name(entry), entry.state));
  }
  return moves;
}

/// What a file of a format ends in, as `--as` names it; "": of the file's own.
std::string ending_of_format(const std::string& format, const fs::path& own) {
  if (format.empty()) return is_copc_ending(own) ? ".copc.laz" : own.extension().string();
  return format == "copc" ? ".copc.laz" : "." + format;
}

/// A name for each in the folder; files of one name from different folders are numbered.
void name_outputs(std::vector<Move>& moves, const fs::path& folder, const std::string& ending) {
  std::set<fs::path> taken;
  for (Move& move : moves) {
    const ScanInFile named = scan_in_file(move.entry.file);
    const fs::path from(named.file);
    std::string end = ending_of_format(ending, from);
    // A file of several stations is written as E57. So is a single station of it if its format cannot be
    // written.
    const bool one_of_several = named.index && !is_cloud_ending("cloud" + end);
    if (ending.empty() && (move.several || one_of_several)) end = ".e57";
    // What is bent is written point by point.
    if (move.entry.bend && !is_cloud_ending("cloud" + end)) end = ".ply";
    const std::string stem = (is_copc_ending(from) ? from.stem() : from).stem().string() +
                             (named.index    ? fmt::format("_{}", *named.index)
                              : move.several ? fmt::format("_{}", move.entry.index)
                                             : std::string());
    move.output = folder / (stem + end);
    for (int k = 2; !taken.insert(move.output).second; ++k)
      move.output = folder / fmt::format("{}_{}{}", stem, k, end);
  }
}

/// All that will be read is there, and what the project is about: else the first scans would be written
/// before the last is missed.
void check_inputs(const std::vector<Move>& moves, const StatedTrajectories& trajectories,
                  const ProjectMoveOptions& options, const Session& session) {
  session.monitor->begin_stage("files");
  std::set<std::string> checked;
  bool bent = false;
  for (std::size_t k = 0; k < moves.size(); ++k) {
    session.monitor->throw_if_cancelled();
    const ProjectEntry& entry = moves[k].entry;
    bent = bent || entry.bend;
    if (checked.insert(entry.file).second) require_registered_file(entry, options.project, options.force);
    session.monitor->advance(static_cast<double>(k + 1), static_cast<double>(moves.size()));
  }
  if (!bent || options.merge) return;
  for (const std::string& file : trajectories.files) require_readable(file, "restore the trajectory");
}

/// None of what is written replaces a scan or a model of the project, placed or not.
void check_output(const fs::path& output, const std::vector<ProjectEntry>& entries) {
  std::error_code ignored;
  if (!fs::exists(output, ignored)) return;
  for (const ProjectEntry& entry : entries) refuse_same_file(output.string(), entry.file);
}

/// Scans without a place are not written; of each that an earlier run wrote the cloud is still there.
void leave_out_unplaced(std::vector<Move>& moves, const Session& session) {
  std::error_code ignored;
  for (const Move& move : moves) {
    const bool left = !move.entry.frame_from_scan && !move.output.empty() &&
                      fs::exists(move.output, ignored) &&
                      !fs::equivalent(move.output, move.entry.file, ignored);
    if (left)
      session.warn(fmt::format("{}: is of an earlier run; its scan {} has no place now", move.output.string(),
                               scan_name(move.entry)));
  }
  std::erase_if(moves, [](const Move& move) { return !move.entry.frame_from_scan; });
}

/// The poses of a project are in metres, and a cloud is moved, not scaled: the frame gets the unit of the
/// files. Throws Error where they have several, or a bent pass has another than metres.
void to_unit_of_files(std::vector<Move>& moves, const ProjectMoveOptions& options, const Session& session) {
  std::map<std::string, double> units;
  for (const Move& move : moves) {
    if (units.count(move.entry.file) == 0) units[move.entry.file] = unit_of_input(move.entry.file, {});
  }
  const auto& [first, unit] = *units.begin();
  for (const auto& [file, other] : units) {
    if (other == unit) continue;
    throw Error(fmt::format("has its numbers in {}, and {} in {}, but a cloud is moved only, not scaled",
                            unit_name(other), first, unit_name(unit)),
                file, "convert all scans to one unit first, and run limen project again");
  }
  if (unit == 1.0) return;
  for (Move& move : moves) {
    if (move.entry.bend)
      throw Error(fmt::format("is bent, but its numbers are in {}", unit_name(unit)), move.entry.file,
                  "convert all scans to metres first, and run limen project again");
    move.entry.frame_from_scan->translation /= unit;
  }
  session.note(fmt::format("{}: written in {}, the unit of its files", options.output, unit_name(unit)));
}

std::size_t write_each(std::vector<Move>& moves, const StatedTrajectories& trajectories,
                       const ProjectMoveOptions& options, const CoordinateSystem& system,
                       const Session& session) {
  const OutputFolder folder(options.output);
  std::size_t points = 0;
  for (const Move& move : moves) {
    const Rigid3& pose = *move.entry.frame_from_scan;
    const StationToMove station{move.entry.file, static_cast<std::size_t>(move.entry.index), pose,
                                move.entry.bend};
    const TransformedCloud cloud =
        move.several || move.entry.bend
            ? move_stations({station}, move.output, *session.monitor, system)
            : transform_cloud(move.entry.file, pose, move.output, {}, *session.monitor, system);
    if (move.entry.bend) {
      for (const std::string& note :
           write_pass_trajectory(move.entry, trajectories, system, move.output, *session.monitor))
        session.note(move.output.string() + ": " + note);
    }
    points += cloud.points;
    for (const std::string& note : cloud.notes) session.note(move.output.string() + ": " + note);
  }
  return points;
}

std::size_t write_merged(const std::vector<Move>& moves, const std::vector<ProjectEntry>& entries,
                         const ProjectMoveOptions& options, const CoordinateSystem& system,
                         const Session& session) {
  fs::path output(options.output);
  if (!options.ending.empty()) {
    const std::string ending = ending_of_format(options.ending, output);
    if (!output.string().ends_with(ending)) output += ending;
  }
  check_output(output, entries);
  std::vector<StationToMove> stations;
  for (const Move& move : moves) {
    stations.push_back({move.entry.file, static_cast<std::size_t>(move.entry.index),
                        *move.entry.frame_from_scan, move.entry.bend});
  }
  const TransformedCloud cloud = move_stations(stations, output, *session.monitor, system);
  for (const std::string& note : cloud.notes) session.note(note);
  return cloud.points;
}

int run(const ProjectMoveOptions& options, const Session& session) {
  const CancelScope scope(*session.monitor);
  const std::vector<ProjectEntry> entries = read_project(options.project);
  check_words(options);
  std::vector<Move> moves = moves_of(entries, session);
  if (!options.merge) name_outputs(moves, options.output, options.ending);
  leave_out_unplaced(moves, session);
  for (const Move& move : moves) check_output(move.output, entries);
  const CoordinateSystem stated = read_project_system(options.project);
  const CoordinateSystem chosen = chosen_system(options.crs);
  if (!same_system(stated, chosen))
    session.note(
        fmt::format("the project states the coordinate system {}, but --crs gives {}, which is written",
                    words_of(stated), words_of(chosen)));
  const CoordinateSystem& system = chosen.known() ? chosen : stated;
  if (moves.empty())
    throw Error("no scan has a pose in the project's frame", options.project,
                "give a project with registered scans");
  const StatedTrajectories trajectories =
      options.merge ? StatedTrajectories() : read_project_trajectories(options.project);
  check_inputs(moves, trajectories, options, session);
  to_unit_of_files(moves, options, session);
  const std::size_t points = options.merge ? write_merged(moves, entries, options, system, session)
                                           : write_each(moves, trajectories, options, system, session);
  const Json json = {
      {"input", options.project}, {"output", options.output}, {"scans", moves.size()}, {"points", points}};
  session.say(
      fmt::format("{} points of {} scans moved; written to {}\n", points, moves.size(), options.output));
  session.answer(to_text(json));
  return kExitOk;
}

}  // namespace

bool asked_project_move(int argc, char** argv) {
  if (argc < 3 || std::string_view(argv[1]) != "transform") return false;
  if (argc == 3 && fs::path(argv[2]).filename() == "project.json") return true;
  return std::any_of(argv + 2, argv + argc, [](const char* word) {
    const std::string_view text(word);
    return text == "-o" || text == "--output" || text.substr(0, 9) == "--output=";
  });
}

void add_transform_project_command(CommandLine& app, Session& session) {
  auto options = std::make_shared<ProjectMoveOptions>();
  CommandLine* command = add_command(app, session, kProjectMove, "Move all scans of a project into its frame",
                                     [options, &session] { return run(*options, session); });
  command->group("");
  command->add_option("PROJECT", options->project, "The project.json that limen project wrote")->required();
  command->add_option("-o,--output OUT", options->output, "A folder, or with --merge a file")->required();
  command->add_option("--as", options->ending, "Format of the output (default: each scan's own)")
      ->one_of({"e57", "las", "laz", "copc", "ply"});
  command->add_flag("--merge", options->merge, "All scans in one file");
  command->add_flag("--force", options->force,
                    "Accept files that are not the registered ones, for example copies in the same frame");
  add_crs_option(*command, options->crs);
  // Options of a pair's transform, which do not apply here.
  command->add_flag("--invert", options->invert, "Only for the result of a pair")->group("");
  command->add_option("--alternative", options->alternative, "Only for the result of a pair")->group("");
}

}  // namespace limen
