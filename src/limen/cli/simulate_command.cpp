// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/simulate_command.h"

#include <memory>
#include <string>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <fmt/format.h>

#include "limen/base/atomic_file.h"
#include "limen/io/write_ply.h"
#include "limen/report/truth_json.h"
#include "limen/simulate/scene.h"

namespace limen {
namespace {

struct SimulateOptions {
  std::string output;
  SceneOptions scene;
};

std::string summary(const SimulatedCase& simulated, const std::string& folder) {
  std::string text;
  for (const Scan& scan : simulated.scans) {
    text += fmt::format("{:<16} {:>9} points, {}\n", scan.name + ".ply", scan.size(),
                        scan.mobile() ? "mobile, world coordinates" : "station, its own frame");
  }
  return text + fmt::format("written to {} with task.json; the truth is in truth/truth.json\n", folder);
}

int run(SimulateOptions& options, const Session& session) {
  options.scene.seed = session.common.seed;
  options.scene.check();
  // Made before the long work: a place that cannot be written to is told at once.
  const OutputFolder folder(options.output);
  const OutputFolder truth_folder(folder.path() / "truth");
  const SimulatedCase simulated = simulate(options.scene, *session.monitor);
  session.monitor->begin_stage("writing");
  for (const Scan& scan : simulated.scans) {
    session.monitor->throw_if_cancelled();
    write_ply(folder.path() / (scan.name + ".ply"), scan);
  }
  const std::string task = task_json(simulated);
  write_file(truth_folder.path() / "truth.json", truth_json(simulated.truth));
  write_file(folder.path() / "task.json", task);
  session.say(summary(simulated, options.output));
  session.answer(task);
  return kExitOk;
}

std::string known_scenes() {
  std::string known;
  for (const std::string& name : scene_names()) known += (known.empty() ? "" : ", ") + name;
  return known;
}

void add_count_option(CLI::App& command, const std::string& name, std::size_t& count,
                      const std::string& description) {
  command.add_option(name, count, description + "; 0: the scene's own (default)")->type_name("N");
}

}  // namespace

void add_simulate_command(CLI::App& app, Session& session) {
  auto options = std::make_shared<SimulateOptions>();
  CLI::App* command =
      add_command(app, session, "simulate", "Scan a made-up building whose truth is known exactly",
                  [options, &session] { return run(*options, session); });
  SceneOptions& scene = options->scene;
  command->add_option("NAME", scene.name, "The scene: " + known_scenes())->required();
  command->add_option("-o,--output", options->output, "The folder for scans, task.json and truth/truth.json")
      ->required()
      ->type_name("DIR");
  add_count_option(*command, "--points-indoor", scene.points_indoor, "Points of each station, about");
  add_count_option(*command, "--points-outdoor", scene.points_outdoor, "Points of the mobile scan, about");
  add_count_option(*command, "--stations", scene.stations, "Number of stations");
  add_count_option(*command, "--facades", scene.facades,
                   "Facades the first station's room has open windows in (museum, townhouse, villa)");
  command->add_flag("--any-rotation", scene.any_rotation, "Give stations any rotation, not only any heading");
  command
      ->add_option("--curtain-share", scene.curtain_share,
                   "Share of the windows with a drawn curtain or blind")
      ->type_name("SHARE");
  add_length_option(*command, "--noise-m", scene.scanner.noise_m,
                    "Range noise, one standard deviation (default 0.003)");
  add_length_option(*command, "--drift-m", scene.drift_m, "Slow error of the mobile scan's path (default 0)");
}

}  // namespace limen
