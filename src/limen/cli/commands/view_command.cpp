// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/commands/view_command.h"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "limen/base/atomic_file.h"
#include "limen/base/progress.h"
#include "limen/cli/inputs/scan_options.h"
#include "limen/cli/inputs/view_inputs.h"
#include "limen/report/json/json_values.h"

namespace limen {
namespace {

constexpr int kFewestViewed = 1000;
constexpr int kMostViewed = 1'500'000;

struct ViewCommand {
  std::vector<std::string> files;
  std::string output = "view.html";
  std::string title;
  std::string units;
  int most_points = 1'000'000;
  int alternative = 0;
};

std::string viewed_as_json(const ViewCommand& command, const ViewScene& scene, std::size_t bytes) {
  Json json;
  json["output"] = command.output;
  json["bytes"] = bytes;
  json["files"] = Json::array();
  for (const ViewSide& side : scene.sides)
    json["files"].push_back({{"name", side.name},
                             {"points_read", side.points_read},
                             {"points_shown", side.scene.points.size()},
                             {"faces_shown", side.scene.faces.size()}});
  return to_text(json);
}

std::string title_of(const ViewCommand& command, const ViewScene& scene) {
  if (!command.title.empty()) return command.title;
  std::string title = scene.sides.front().name;
  for (std::size_t k = 1; k < scene.sides.size() && k < 3; ++k) title += ", " + scene.sides[k].name;
  if (scene.sides.size() > 3) title += fmt::format(" and {} more", scene.sides.size() - 3);
  return title;
}

int run(const ViewCommand& command, const Session& session) {
  for (const std::string& file : command.files) refuse_same_file(command.output, file);
  const std::vector<ViewInput> inputs = view_inputs(command.files, command.alternative, session);
  for (const ViewInput& input : inputs) refuse_same_file(command.output, input.path);
  // Opened before the long work: a place that cannot be written to is an error at once.
  AtomicFile file(command.output);
  const CancelScope scope(*session.monitor);
  session.monitor->begin_stage("reading");
  ViewScene scene = read_view(inputs, static_cast<std::size_t>(command.most_points),
                              metres_per_unit_of(command.units), session);
  scene.title = title_of(command, scene);
  const std::string page = view_page(scene);
  file.write(page);
  file.commit();
  session.say(fmt::format("{} file{}, {:.1f} MB; written to {}: open it in a browser\n", scene.sides.size(),
                          scene.sides.size() == 1 ? "" : "s", static_cast<double>(page.size()) / 1e6,
                          command.output));
  session.answer(viewed_as_json(command, scene, page.size()));
  return kExitOk;
}

}  // namespace

void add_view_command(CommandLine& app, Session& session) {
  auto options = std::make_shared<ViewCommand>();
  CommandLine* command =
      add_command(app, session, "view", "Write a web page to view, section and measure scans and models",
                  [options, &session] { return run(*options, session); });
  command
      ->add_option(
          "FILE", options->files,
          "Scans and models in one frame, a result.json (both its sides), or a project.json (all its "
          "scans)")
      ->required();
  command->add_option("-o,--output", options->output, "The page to write (default view.html)")
      ->type_name("FILE");
  command
      ->add_option("--most-points", options->most_points,
                   "Number of points of all files together (default 1000000); scans are thinned evenly")
      ->in_range(kFewestViewed, kMostViewed)
      ->type_name("N");
  command->add_option("--title", options->title, "Heading of the page (default: the names of the files)")
      ->type_name("WORDS");
  add_alternative_option(*command, options->alternative);
  add_units_option(*command, options->units);
}

}  // namespace limen
