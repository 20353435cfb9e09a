// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/commands/transform_project.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "limen/base/atomic_file.h"
#include "limen/base/error.h"
#include "limen/cli/inputs/frame_system.h"
#include "limen/cli/inputs/project_trajectories.h"
#include "limen/cli/inputs/scan_options.h"
#include "limen/io/cloud/cloud_writers.h"
#include "limen/io/cloud/transform_cloud.h"
#include "limen/report/json/json_values.h"
#include "limen/report/project/read_project.h"

namespace limen {
namespace {

namespace fs = std::filesystem;

/// What the user says of moving the scans of a project.
struct ProjectMoveOptions {
  std::string project;  ///< project.json
  std::string output;   ///< a folder, or with `merge` a file
  std::string ending;   ///< "e57", "las", "ply", or empty: each as it is
  bool merge = false;   ///< all in one file
  std::string crs;      ///< of the frame, where the user says it
};

/// A scan that is written, and to where.
struct Move {
  ProjectEntry entry;
  bool several = false;  ///< its file holds others
  fs::path output;
};

/// The scans with a place, by file; others are named.
std::vector<Move> moves_of(const std::vector<ProjectEntry>& entries, const Session& session) {
  std::map<std::string, int> in_file;
  for (const ProjectEntry& entry : entries) ++in_file[entry.file];
  std::vector<Move> moves;
  for (const ProjectEntry& entry : entries) {
    if (entry.model) continue;
    if (!entry.frame_from_scan) {
      session.note(fmt::format("{}: {}, not written", entry.file, entry.state));
      continue;
    }
    if (entry.state != "registered")
      session.note(fmt::format("{}: its place is {}: check it", entry.file, entry.state));
    moves.push_back({entry, in_file[entry.file] > 1, {}});
  }
  return moves;
}

/// A name for each in the folder; files of one name from different folders are numbered.
void name_outputs(std::vector<Move>& moves, const fs::path& folder, const std::string& ending) {
  std::set<fs::path> taken;
  for (Move& move : moves) {
    const fs::path from(move.entry.file);
    std::string end = ending.empty() ? from.extension().string() : "." + ending;
    // A file of several stations becomes E57.
    if (ending.empty() && move.several) end = ".e57";
    // What is bent is written point by point.
    if (move.entry.bend && !is_cloud_ending("cloud" + end)) end = ".ply";
    const std::string stem =
        from.stem().string() + (move.several ? fmt::format("_{}", move.entry.index) : std::string());
    move.output = folder / (stem + end);
    for (int k = 2; !taken.insert(move.output).second; ++k)
      move.output = folder / fmt::format("{}_{}{}", stem, k, end);
  }
}

std::size_t write_each(std::vector<Move>& moves, const ProjectMoveOptions& options,
                       const CoordinateSystem& system, const Session& session) {
  const OutputFolder folder(options.output);
  const ToldTrajectories trajectories = read_project_trajectories(options.project);
  name_outputs(moves, folder.path(), options.ending);
  std::size_t points = 0;
  for (const Move& move : moves) {
    refuse_same_file(move.output.string(), move.entry.file);
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

std::size_t write_merged(const std::vector<Move>& moves, const ProjectMoveOptions& options,
                         const CoordinateSystem& system, const Session& session) {
  fs::path output(options.output);
  if (!options.ending.empty() && output.extension() != "." + options.ending) output += "." + options.ending;
  std::vector<StationToMove> stations;
  for (const Move& move : moves) {
    refuse_same_file(output.string(), move.entry.file);
    stations.push_back({move.entry.file, static_cast<std::size_t>(move.entry.index),
                        *move.entry.frame_from_scan, move.entry.bend});
  }
  const TransformedCloud cloud = move_stations(stations, output, *session.monitor, system);
  for (const std::string& note : cloud.notes) session.note(note);
  return cloud.points;
}

int run(const ProjectMoveOptions& options, const Session& session) {
  const CancelScope scope(*session.monitor);
  std::vector<Move> moves = moves_of(read_project(options.project), session);
  const CoordinateSystem told = read_project_system(options.project);
  const CoordinateSystem chosen = chosen_system(options.crs);
  if (!same_system(told, chosen))
    session.note(fmt::format("the project says that its frame is {}; --crs says {}, and that is told",
                             words_of(told), words_of(chosen)));
  const CoordinateSystem& system = chosen.known() ? chosen : told;
  if (moves.empty())
    throw Error("no scan has a place in the frame", options.project, "give a project that joined some");
  const std::size_t points = options.merge ? write_merged(moves, options, system, session)
                                           : write_each(moves, options, system, session);
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
  command->add_option("-o,--output", options->output, "A folder, or with --merge a file")
      ->required()
      ->type_name("OUT");
  command->add_option("--as", options->ending, "Format of what is written; else each scan's own")
      ->one_of({"e57", "las", "laz", "ply"});
  command->add_flag("--merge", options->merge, "All scans in one file");
  add_crs_option(*command, options->crs);
}

}  // namespace limen
