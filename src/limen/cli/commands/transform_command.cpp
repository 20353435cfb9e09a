// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "limen/base/atomic_file.h"
#include "limen/base/error.h"
#include "limen/base/length_unit.h"
#include "limen/cli/commands/commands.h"
#include "limen/cli/inputs/frame_system.h"
#include "limen/cli/inputs/registered_file.h"
#include "limen/cli/inputs/scan_options.h"
#include "limen/files/file_hash.h"
#include "limen/files/scan_in_file.h"
#include "limen/io/cloud/open_points.h"
#include "limen/io/cloud/transform_cloud.h"
#include "limen/io/cloud/write_clouds.h"
#include "limen/report/json/json_values.h"
#include "limen/report/pose_file.h"
#include "limen/report/project/read_project.h"

namespace limen {
namespace {

struct TransformOptions {
  std::string result;
  std::string cloud;
  std::string output;
  bool invert = false;
  bool force = false;
  bool split = false;
  int alternative = 0;
  std::vector<std::string> merge;
  std::string crs;
};

std::string as_json(const TransformOptions& options, const TransformedCloud& cloud) {
  Json json;
  json["input"] = options.cloud;
  json["output"] = options.output;
  json["format"] = cloud.format;
  json["points"] = cloud.points;
  json["notes"] = cloud.notes;
  return to_text(json);
}

/// A pose moves what it was found for. Throws Error where the file's bytes are those of neither side, or of
/// the side that stays.
void check_cloud(const TransformOptions& options, const PoseFile& pose) {
  const std::string& wanted = options.invert ? pose.target_sha256 : pose.source_sha256;
  const std::string& other = options.invert ? pose.source_sha256 : pose.target_sha256;
  if (options.force || wanted.empty()) return;
  const std::string hash = sha256_of_file(file_of_scan(options.cloud));
  if (hash.empty() || hash == wanted) return;
  if (hash == other) {
    throw Error(fmt::format("is the {} of {}, which is not moved", options.invert ? "source" : "target",
                            options.result),
                options.cloud,
                options.invert ? "leave --invert out, or add --force" : "add --invert, or --force");
  }
  throw Error(
      fmt::format("is neither of the two files registered in {}: its SHA-256 is different", options.result),
      options.cloud, "give the registered file, or add --force if this file is in the same frame");
}

/// A pose in metres for clouds whose numbers are in a unit of their own. Throws Error where the two differ: a
/// cloud is moved, not scaled.
Rigid3 in_unit_of_clouds(Rigid3 pose, const PoseFile& file, const std::string& path) {
  const double unit = file.source_metres_per_unit.value_or(1.0);
  const double target_unit = file.target_metres_per_unit.value_or(1.0);
  if (unit != target_unit) {
    throw Error(
        fmt::format("has its source in {} and its target in {}, but a cloud is moved only, not scaled",
                    unit_name(unit), unit_name(target_unit)),
        path,
        "convert both files to one unit, or apply transform.txt, which includes the scale, in another "
        "program");
  }
  pose.translation /= unit;
  return pose;
}

Rigid3 read_pose(const TransformOptions& options, const PoseFile& pose, const Session& session) {
  const Rigid3 target_from_source =
      in_unit_of_clouds(chosen_pose(pose, options.alternative, options.result), pose, options.result);
  check_cloud(options, pose);
  note_other_scan(options.invert ? pose.target_path : pose.source_path, options.cloud, session);
  return options.invert ? inverse(target_from_source) : target_from_source;
}

PoseFile unmoved() {
  PoseFile pose;
  pose.target_from_source = Rigid3{};
  return pose;
}

/// A file for each scan with points: "all_0.e57", as project results are named, whatever the scans are
/// called.
TransformedCloud split_cloud(const TransformOptions& options, const Rigid3& target_from_source,
                             const CoordinateSystem& system, const Session& session) {
  if (!options.merge.empty())
    throw Error("--split and --merge exclude each other", "--split", "give one of them");
  if (has_cloud_ending(options.output))
    throw Error("looks like a file name, but --split writes a file for each scan into a folder",
                options.output, "give the name of a folder");
  const std::filesystem::path input(options.cloud);
  std::size_t scans = 0;
  {
    const OpenPoints opened(input);
    scans = scans_with_points(opened.file()).size();
  }
  const OutputFolder folder(options.output);
  const auto output = [&](std::size_t k) {
    return folder.path() / fmt::format("{}_{}.e57", input.stem().string(), k);
  };
  for (std::size_t k = 0; k < scans; ++k) refuse_same_file(output(k).string(), options.cloud);
  TransformedCloud all;
  for (std::size_t k = 0; k < scans; ++k) {
    TransformedCloud one =
        move_stations({{input, k, target_from_source}}, output(k), *session.monitor, system);
    all.points += one.points;
    all.format = std::move(one.format);
    for (const std::string& note : one.notes) all.notes.push_back(output(k).string() + ": " + note);
  }
  return all;
}

int run(const TransformOptions& options, const Session& session) {
  if (is_project(options.result))
    throw Error("is a project, which is transformed with -o OUT and takes no cloud", options.result,
                fmt::format("use limen transform {} -o OUT, which moves all of its scans", options.result));
  refuse_same_file(options.output, options.cloud);
  refuse_same_file(options.output, options.result);
  const PoseFile pose = options.result == "identity" ? unmoved() : read_pose_file(options.result);
  for (const std::string& registered : {pose.source_path, pose.target_path})
    if (!registered.empty()) refuse_same_file(options.output, registered);
  const Rigid3 target_from_source = read_pose(options, pose, session);
  for (const std::string& other : options.merge) refuse_same_file(options.output, other);
  const CancelScope scope(*session.monitor);
  const CoordinateSystem system = chosen_system(options.crs);
  const TransformedCloud cloud = options.split
                                     ? split_cloud(options, target_from_source, system, session)
                                     : merge_clouds({options.cloud, target_from_source}, options.merge,
                                                    options.output, *session.monitor, system);
  if (options.alternative == 0) warn_of_doubt(pose, options.result, session);
  for (const std::string& note : cloud.notes) session.note(note);
  session.say(fmt::format("{} points moved; written to {}\n", cloud.points, options.output));
  session.answer(as_json(options, cloud));
  return kExitOk;
}

}  // namespace

void add_transform_command(CommandLine& app, Session& session) {
  auto options = std::make_shared<TransformOptions>();
  CommandLine* command =
      add_command(app, session, "transform",
                  "Move a cloud by the pose of a registration, and merge it with others if asked",
                  [options, &session] { return run(*options, session); });
  command
      ->add_option("RESULT", options->result,
                   "result.json, a text file with a 4 x 4 matrix, or the word identity")
      ->required();
  command->add_option("CLOUD", options->cloud, "The cloud to move, of any format limen reads")->required();
  command
      ->add_option(
          "OUT", options->output,
          "The file to write: of CLOUD's own format, which keeps all of it, or .ply, .las, .laz, .copc.laz, "
          ".e57, .xyz; with --split a folder")
      ->required();
  command
      ->add_option(
          "--merge FILE", options->merge,
          "A cloud that is already in the target's frame, written to OUT too; may be given several times")
      ->type_size(1)
      ->take_all();
  command->add_flag("--split", options->split,
                    "Write each scan of CLOUD to an E57 of its own, into the folder OUT");
  command->add_flag("--invert", options->invert, "Move from the target's frame to the source's instead");
  add_alternative_option(*command, options->alternative);
  add_crs_option(*command, options->crs);
  command->add_flag("--force", options->force,
                    "Accept a CLOUD that is not the registered file, for example a copy in the same frame");
}

}  // namespace limen
