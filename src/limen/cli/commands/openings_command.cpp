// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/base/text.h"
#include "limen/cli/commands/commands.h"
#include "limen/cli/inputs/feature_command.h"
#include "limen/extract/model/model_features.h"
#include "limen/extract/openings/openings.h"
#include "limen/report/json/features_json.h"

namespace limen {
namespace {

struct OpeningsCommand : FeatureChoice {
  OpeningOptions openings;
};

std::string opening_line(const Opening& it) {
  const auto side = [&](std::size_t k) {
    return it.edge_sigma_m[k] < 1.0 ? fmt::format("{:6.1f}", 1e3 * it.edge_sigma_m[k]) : "unseen";
  };
  return fmt::format("{:10.3f} {:10.3f} {:9}   {:8}  {} {} {} {}\n", (it.corners[1] - it.corners[0]).norm(),
                     (it.corners[3] - it.corners[0]).norm(), it.evidence, to_string(it.view), side(0),
                     side(1), side(2), side(3));
}

std::string summary(const std::vector<Opening>& openings) {
  std::string text = fmt::format("{} openings\n", openings.size());
  if (!openings.empty())
    text +=
        "   width m   height m      rays   view      sigma of the sides, mm (lower, right, upper, left)\n";
  return text + first_lines(openings, 20, opening_line);
}

int run(const OpeningsCommand& command, const Session& session) {
  command.openings.check();
  FeatureTask task;
  task.stage = "openings";
  task.of_scan.openings = command.openings;
  task.of_model = [](const BimModel& model) { return model_features(model).features; };
  task.json = [](const Features& features, const InputSummary& input) {
    if (input.kind == "scan" && input.place.source == PlaceSource::unknown) {
      throw Error("the scanner position is unknown and cannot be estimated from the points", input.path,
                  "give the scanner position with --origin x,y,z");
    }
    return openings_json(features, input);
  };
  task.summary = [](const Features& features, const InputSummary&) { return summary(features.openings); };
  return take_features(command, std::move(task), session);
}

}  // namespace

void add_openings_command(CommandLine& app, Session& session) {
  auto options = std::make_shared<OpeningsCommand>();
  CommandLine* command =
      add_command(app, session, "openings", "Find the windows and doors of a scan or a model",
                  [options, &session] { return run(*options, session); });
  add_feature_options(*command, *options);
  OpeningOptions& o = options->openings;
  add_length_option(*command, "--min-width-m", o.min_width_m,
                    "Width of the narrowest opening (default 0.35)");
  add_length_option(*command, "--min-height-m", o.min_height_m,
                    "Height of the lowest opening (default 0.35)");
  add_length_option(*command, "--max-width-m", o.max_width_m, "Width of the widest opening (default 6)");
  add_length_option(*command, "--max-height-m", o.max_height_m, "Height of the highest opening (default 6)");
}

}  // namespace limen
