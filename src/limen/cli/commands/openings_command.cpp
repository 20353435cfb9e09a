// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "limen/base/atomic_file.h"
#include "limen/base/error.h"
#include "limen/bim/read_bim.h"
#include "limen/cli/commands/commands.h"
#include "limen/cli/inputs/scan_options.h"
#include "limen/extract/model/model_features.h"
#include "limen/extract/openings/openings.h"
#include "limen/report/json/features_json.h"

namespace limen {
namespace {

struct OpeningsCommand : FeatureChoice {
  OpeningOptions openings;
};

std::string summary(const std::vector<Opening>& openings, const std::string& output) {
  std::string text = fmt::format("{} openings\n", openings.size());
  if (!openings.empty())
    text +=
        "   width m   height m      rays   view      sigma of the sides, mm (lower, right, upper, left)\n";
  constexpr std::size_t kShown = 20;
  for (std::size_t i = 0; i < std::min(kShown, openings.size()); ++i) {
    const Opening& it = openings[i];
    const auto side = [&](std::size_t k) {
      return it.edge_sigma_m[k] < 1.0 ? fmt::format("{:6.1f}", 1e3 * it.edge_sigma_m[k]) : "unseen";
    };
    text += fmt::format("{:10.3f} {:10.3f} {:9}   {:8}  {} {} {} {}\n",
                        (it.corners[1] - it.corners[0]).norm(), (it.corners[3] - it.corners[0]).norm(),
                        it.evidence, to_string(it.view), side(0), side(1), side(2), side(3));
  }
  if (openings.size() > kShown) text += fmt::format("... {} more\n", openings.size() - kShown);
  return text + fmt::format("written to {}\n", output);
}

int run_model(const OpeningsCommand& command, const Session& session) {
  const BimModel model =
      read_model_input(command.scan, session, metres_per_unit_of(command.reading.units), "--units");
  session.monitor->begin_stage("openings");
  AtomicFile file(command.output);
  const Features features = model_features(model).features;
  const std::string json = openings_json(features, summarise(command.scan, model));
  return deliver(file, json, summary(features.openings, command.output), session);
}

int run(const OpeningsCommand& command, const Session& session) {
  command.openings.check();
  refuse_same_file(command.output, command.scan);
  if (is_bim_file(command.scan)) return run_model(command, session);
  FeatureScan read = read_feature_scan(command, session);
  // Opened before the long work: a place that cannot be written to is an error at once.
  AtomicFile file(command.output);
  session.monitor->begin_stage("openings");
  PrepareOptions preparing;
  preparing.extract.detect.seed = session.common.seed;
  preparing.gravity = gravity_of(command.gravity);
  preparing.openings = command.openings;
  const Features features = features_of(std::move(read.scan), preparing, read.input, session);
  if (read.input.place.source == PlaceSource::unknown) {
    throw Error("the scanner position is unknown and cannot be estimated from the points", command.scan,
                "give the scanner position with --origin x,y,z");
  }
  const std::string json = openings_json(features, read.input);
  return deliver(file, json, summary(features.openings, command.output), session);
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
