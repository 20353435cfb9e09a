// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/commands/transform_command.h"

#include <memory>
#include <string>
#include <vector>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/cli/inputs/scan_options.h"
#include "limen/io/cloud/transform_cloud.h"
#include "limen/report/json/json_values.h"
#include "limen/report/pose_file.h"

namespace limen {
namespace {

struct TransformOptions {
  std::string result;
  std::string cloud;
  std::string output;
  bool invert = false;
  std::vector<std::string> merge;
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

Rigid3 read_pose(const TransformOptions& options, const Session& session) {
  const PoseFile pose = read_pose_file(options.result);
  if (!pose.target_from_source) {
    throw Error("holds no pose: nothing in common was found", options.result,
                "give the result of a registration that found one");
  }
  if (pose.outcome && *pose.outcome != Outcome::registered) {
    session.note(fmt::format("the pose in {} is {}: check it", options.result, to_string(*pose.outcome)));
  }
  return options.invert ? inverse(*pose.target_from_source) : *pose.target_from_source;
}

int run(const TransformOptions& options, const Session& session) {
  refuse_same_file(options.output, options.cloud);
  refuse_same_file(options.output, options.result);
  const Rigid3 target_from_source = read_pose(options, session);
  for (const std::string& other : options.merge) refuse_same_file(options.output, other);
  const CancelScope scope(*session.monitor);
  const TransformedCloud cloud =
      merge_clouds({options.cloud, target_from_source}, options.merge, options.output, *session.monitor);
  for (const std::string& note : cloud.notes) session.note(note);
  session.say(fmt::format("{} points moved; written to {}\n", cloud.points, options.output));
  session.answer(as_json(options, cloud));
  return kExitOk;
}

}  // namespace

void add_transform_command(CLI::App& app, Session& session) {
  auto options = std::make_shared<TransformOptions>();
  CLI::App* command =
      add_command(app, session, "transform", "Move a cloud by a found pose, and merge it with others",
                  [options, &session] { return run(*options, session); });
  command->add_option("RESULT", options->result, "result.json, or a text of 4 x 4 numbers")->required();
  command->add_option("CLOUD", options->cloud, "The cloud to move, of any format limen reads")->required();
  command
      ->add_option("OUT", options->output,
                   "The file to write: of CLOUD's own format, which keeps all of it, or .ply, .las, .e57")
      ->required();
  command
      ->add_option(
          "--merge", options->merge,
          "A cloud that lies in the target's frame already, written to OUT too; may be given several times")
      ->type_name("FILE")
      ->type_size(1)
      ->take_all();
  command->add_flag("--invert", options->invert, "Move from the target's frame to the source's instead");
}

}  // namespace limen
