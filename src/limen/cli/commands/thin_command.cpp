// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/cli/commands/commands.h"
#include "limen/cli/inputs/scan_options.h"
#include "limen/io/cloud/open_points.h"
#include "limen/io/cloud/write_clouds.h"
#include "limen/report/json/json_values.h"

namespace limen {
namespace {

constexpr double kLeastOfAsked = 0.7;  // of --points, as the documentation has it

struct ThinCommand {
  std::string cloud;
  std::string output;
  ThinOptions thinning;
  std::string memory;
};

std::string as_json(const ThinCommand& command, const WrittenClouds& written, const OpenPoints& input) {
  Json json;
  json["input"] = command.cloud;
  json["output"] = command.output;
  json["format"] = input.file().format();
  json["points_read"] = written.read;
  json["points_written"] = written.written;
  json["spacing_m"] = written.spacing_m > 0.0 ? Json(written.spacing_m) : Json();
  json["notes"] = written.notes;
  return to_text(json);
}

int run(ThinCommand command, const Session& session) {
  command.thinning.memory_bytes = parse_memory(command.memory);
  if (command.thinning.most_points == 0 && command.thinning.spacing_m == 0.0 && command.memory.empty())
    throw Error("the number of points to keep is not given", "limen thin",
                "give --points, --spacing-m or --memory");
  command.thinning.check();
  refuse_same_file(command.output, command.cloud);
  const OpenPoints input(command.cloud);
  const CancelScope scope(*session.monitor);
  session.monitor->begin_stage("thinning");
  WrittenClouds written = thin_file(input, command.thinning, command.output, *session.monitor);
  const std::uint64_t asked = std::min(command.thinning.most_points, written.read);
  if (command.thinning.memory_bytes > 0 &&
      static_cast<double>(written.written) < kLeastOfAsked * static_cast<double>(asked))
    written.notes.push_back(
        fmt::format("--memory {} allows no more than {} points", command.memory, written.written));
  for (const std::string& note : written.notes) session.note(note);
  std::string text = fmt::format("{} of {} points kept", written.written, written.read);
  if (written.spacing_m > 0.0) text += fmt::format(", spacing about {:.4f} m", written.spacing_m);
  session.say(text + fmt::format("; written to {}\n", command.output));
  session.answer(as_json(command, written, input));
  return kExitOk;
}

}  // namespace

void add_thin_command(CommandLine& app, Session& session) {
  auto options = std::make_shared<ThinCommand>();
  CommandLine* command = add_command(app, session, "thin", "Thin a point cloud of any size evenly",
                                     [options, &session] { return run(*options, session); });
  command->add_option("CLOUD", options->cloud, "A cloud of any format limen reads")->required();
  command->add_option("OUT", options->output, "The file to write: .ply, .las, .laz, .copc.laz, .e57 or .xyz")
      ->required();
  command->add_option("--points N", options->thinning.most_points,
                      "Keep this many points, or a few less; the spacing is chosen to fit");
  add_length_option(*command, "--spacing-m", options->thinning.spacing_m,
                    "Keep one point per cube of this side");
  add_memory_option(*command, options->memory);
}

}  // namespace limen
