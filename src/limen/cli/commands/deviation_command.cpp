// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "limen/base/atomic_file.h"
#include "limen/base/error.h"
#include "limen/base/length_unit.h"
#include "limen/base/text.h"
#include "limen/cli/commands/commands.h"
#include "limen/cli/commands/deviation_project.h"
#include "limen/cli/inputs/cover_option.h"
#include "limen/cli/inputs/issue_file.h"
#include "limen/cli/inputs/register_inputs.h"
#include "limen/cli/inputs/registered_file.h"
#include "limen/cli/inputs/scan_options.h"
#include "limen/report/deviation/deviation_report.h"
#include "limen/report/pose_file.h"

namespace limen {
namespace {

struct DeviationCommand {
  std::string scan;
  std::string model;
  std::string folder;
  std::string result;
  ReadingChoice reading;
  std::string model_units;
  std::string origin;
  std::vector<std::string> with;
  bool identity = false;
  bool inverse = false;
  bool force = false;
  int alternative = 0;
  std::vector<std::string> models;
  int cloud_points = ProjectDeviation{}.cloud_points;
  double colour_limit_m = 0.05;
  DeviationOptions measuring;
  IssueChoice issues;
  CoverChoice cover;
  bool pdf = false;
};

/// The scans of a group as one, about the first one's origin, with the scanner position of every point where
/// all of them are known.
Scan joined(const RegisterInput& input) {
  const auto& scans = input.scans;
  if (scans.size() == 1) return scans.front().scan;
  Scan all;
  all.name = scans.front().scan.name;
  all.local_origin = scans.front().scan.local_origin;
  const bool centres =
      std::all_of(scans.begin(), scans.end(), [](const auto& it) { return it.scan.centre_known(); });
  for (const auto& it : scans) {
    const Rigid3 pose = to_local(it.group_from_scan, it.scan.local_origin, all.local_origin);
    for (std::size_t i = 0; i < it.scan.size(); ++i) {
      all.points.push_back(pose * it.scan.points[i]);
      if (centres) all.centres.push_back(pose * it.scan.centre(i));
    }
  }
  return all;
}

bool same_name(const std::string& a, const std::string& b) {
  return std::filesystem::path(a).filename() == std::filesystem::path(b).filename();
}

/// Whether the result has the model as its source: by its inputs, or by the user.
bool model_is_source(const DeviationCommand& command, const PoseFile& pose, const Session& session) {
  if (command.inverse) return true;
  if (same_name(pose.source_path, command.scan) || same_name(pose.target_path, command.model)) return false;
  if (same_name(pose.source_path, command.model) || same_name(pose.target_path, command.scan)) return true;
  session.note(
      fmt::format("{} does not name these files: its pose is assumed to move the scan to the model (use "
                  "--inverse if it moves the model to the scan)",
                  command.result));
  return false;
}

/// The pose of the scan in the model, both in their world coordinates; of a text in the unit of its numbers.
Rigid3 model_from_scan(const DeviationCommand& command, const PoseFile& pose, bool model_moved,
                       const Session& session, DeviationReport& report) {
  if (command.result.empty()) return {};
  const Rigid3 target_from_source = chosen_pose(pose, command.alternative, command.result);
  report.result_path = command.result;
  if (pose.outcome) report.result_outcome = to_string(*pose.outcome);
  if (command.alternative == 0) warn_of_doubt(pose, command.result, session);
  return model_moved ? inverse(target_from_source) : target_from_source;
}

/// The units that the numbers of the scan and of the model were said to have when they were registered;
/// nothing where the result does not say.
struct RegisteredUnits {
  std::optional<double> of_scan;
  std::optional<double> of_model;
};

RegisteredUnits registered_units(const PoseFile& pose, bool model_moved) {
  if (model_moved) return {pose.target_metres_per_unit, pose.source_metres_per_unit};
  return {pose.source_metres_per_unit, pose.target_metres_per_unit};
}

/// A text has the unit of the files' numbers. Throws Error where the two files differ in it.
void put_in_metres(const PoseFile& pose, const DeviationCommand& command, DeviationReport& report) {
  if (!pose.of_numbers) return;
  if (report.scan.metres_per_unit != report.model.metres_per_unit)
    throw Error(fmt::format("is a text of numbers, and the scan is in {}, but the model in {}",
                            unit_name(report.scan.metres_per_unit), unit_name(report.model.metres_per_unit)),
                command.result, "give the result.json of limen register, which says more");
  report.model_from_scan.translation *= report.model.metres_per_unit;
}

/// A pose holds for what was registered. Throws Error where a file's bytes are those of neither side.
void check_inputs(const DeviationCommand& command, const PoseFile& pose, const DeviationReport& report) {
  if (command.force || pose.source_sha256.empty() || pose.target_sha256.empty()) return;
  for (const InputSummary* input : {&report.scan, &report.model}) {
    const std::string& hash = input->sha256;
    if (hash.empty() || hash == pose.source_sha256 || hash == pose.target_sha256) continue;
    throw Error(
        fmt::format("is neither of the two files registered in {}: its SHA-256 is different", command.result),
        input->path, "give the registered file, or add --force if this file is in the same frame");
  }
}

void check(const DeviationCommand& command) {
  command.measuring.check();
  if (!command.result.empty() && command.identity)
    throw Error("--result and --identity exclude each other", "", "give one of them");
  if (command.result.empty() && !command.identity) {
    throw Error("the pose of the scan in the model is not given", "",
                "give --result with the result.json of limen register, or --identity where both are in one "
                "frame");
  }
}

std::string line_of(const ElementDeviation& it, const BimElement& element) {
  const std::string name = element.name.empty() ? element.type : element.name;
  if (it.presence == Presence::not_found) {
    return fmt::format("{:<12} {:<32.32} not found: the scanner saw through {:.2f} m2 of it\n",
                       to_string(element.kind), name, it.passed_m2);
  }
  const bool held = it.shift.held > 0;
  return fmt::format("{:<12} {:<32.32} {:7.1f} {:7.1f}  {:<6} {:>7} {:3.0f} %\n", to_string(element.kind),
                     name, 1e3 * it.median_m, 1e3 * it.p95_m, it.loa > 0 ? fmt::format("LOA{}", it.loa) : "-",
                     held ? fmt::format("{:.1f}", 1e3 * it.shift.shift_m.norm()) : "-",
                     100.0 * it.covered_share);
}

/// Elements that are missing or deviate most.
std::string element_lines(const DeviationReport& report, const BimModel& model) {
  std::vector<const ElementDeviation*> shown;
  for (const ElementDeviation& it : report.deviation.elements) {
    if (it.presence != Presence::not_judged) shown.push_back(&it);
  }
  const auto urgency = [](const ElementDeviation* it) {
    return it->presence == Presence::not_found ? 1e3 + it->passed_m2 : it->shift.shift_m.norm();
  };
  std::stable_sort(shown.begin(), shown.end(), [&](const ElementDeviation* a, const ElementDeviation* b) {
    return urgency(a) > urgency(b);
  });
  return "                                              median   95 %   class    shift covered   (mm)\n" +
         first_lines(shown, 20, [&](const ElementDeviation* it) {
           return line_of(*it, model.elements[static_cast<std::size_t>(it->element)]);
         });
}

std::string summary(const DeviationReport& report, const BimModel& model, const std::string& folder) {
  const Deviation& deviation = report.deviation;
  std::size_t count[3] = {0, 0, 0};
  for (const ElementDeviation& it : deviation.elements) ++count[static_cast<std::size_t>(it.presence)];
  std::string text = fmt::format("{} points, {} on faces of the model, {} far from all of them\n",
                                 deviation.distance_m.size(), deviation.matched, deviation.far);
  text += fmt::format("{} elements found, {} not found, {} not judged; {} objects not in the model\n",
                      count[0], count[1], count[2], deviation.unmodelled.size());
  text += element_lines(report, model);
  return text + fmt::format("written to {}\n", folder);
}

/// Issues of one scan; returns their number.
std::size_t write_issues(const DeviationCommand& command, const DeviationReport& report, const Scan& scan,
                         const BimModel& model) {
  std::vector<Vector3d> scanners;
  const std::size_t step = 1 + scan.centres.size() / 200;
  for (std::size_t i = 0; i < scan.centres.size(); i += step)
    scanners.push_back(report.model_from_scan * (scan.local_origin + scan.centres[i]));
  const std::vector<IssueModel> models = {issue_model(command.model, model, {})};
  const std::vector<BcfTopic> topics =
      deviation_issues({model, report.deviation.elements, report.deviation.unmodelled, models, {}, scanners},
                       command.issues.options);
  const std::string& dated = command.result.empty() ? command.scan : command.result;
  write_file(command.issues.file, bcf_file(topics, date_of_file(dated)));
  return topics.size();
}

int run_on_project(const DeviationCommand& command, const Session& session) {
  const bool pose_given = !command.result.empty() || command.identity || command.inverse ||
                          command.alternative != 0 || !command.origin.empty() || !command.with.empty();
  if (pose_given)
    throw Error("the poses of the scans are taken from the project", command.scan,
                "leave out --result, --identity, --inverse, --alternative, --origin and --with");
  if (!command.reading.units.empty() || !command.reading.trajectory.empty())
    throw Error("the scans of a project are read as the project read them", command.scan,
                "leave out --units and --trajectory");
  require_trajectory(command.reading);
  const std::filesystem::path browser = browser_for_pdf(command.pdf);
  ProjectDeviation project;
  project.project = command.scan;
  project.models = command.models;
  if (!command.model.empty()) project.models.insert(project.models.begin(), command.model);
  project.folder = command.folder;
  project.memory = command.reading.memory;
  project.force = command.force;
  project.cloud_points = command.cloud_points;
  project.colour_limit_m = command.colour_limit_m;
  project.measuring = command.measuring;
  project.issues = command.issues;
  project.cover = cover_of(command.cover);
  const int status = run_project_deviation(project, session);
  if (command.pdf) write_pdf(browser, command.folder, session);
  return status;
}

int run(const DeviationCommand& command, const Session& session) {
  if (names_project(command.scan)) return run_on_project(command, session);
  if (command.model.empty()) throw Error("there is no model", "MODEL", "give an IFC, OBJ or PLY model");
  if (!command.models.empty())
    throw Error("--model is for projects", "", "give the one model after the scan");
  if (!command.cover.empty() || command.pdf)
    throw Error("a report is made of projects only",
                "--title, --project, --operator, --date, --logo, --language, --pdf",
                "leave them out, or give a project.json");
  command.issues.options.check();
  check(command);
  std::vector<std::string> inputs = {command.scan, command.model};
  inputs.insert(inputs.end(), command.with.begin(), command.with.end());
  if (!command.result.empty()) inputs.push_back(command.result);
  refuse_to_replace(inputs, command.folder, command.issues.file);
  const OutputFolder folder(command.folder);
  DeviationReport report;
  const PoseFile pose_file = command.result.empty() ? PoseFile{} : read_pose_file(command.result);
  const bool model_moved = !command.result.empty() && model_is_source(command, pose_file, session);
  report.model_from_scan = model_from_scan(command, pose_file, model_moved, session, report);
  session.monitor->begin_stage("reading");
  ReadOptions reading = with_choice(read_options(command.origin, "--origin", "up"), command.reading);
  const RegisteredUnits registered = registered_units(pose_file, model_moved);
  if (!reading.metres_per_unit) reading.metres_per_unit = registered.of_scan;
  const InputSide scan_side = read_side({command.scan, command.with, reading, "--units"}, session);
  ReadOptions model_reading;
  model_reading.metres_per_unit = metres_per_unit_of(command.model_units);
  if (!model_reading.metres_per_unit)
    model_reading.metres_per_unit = unit_to_read(command.model, registered.of_model);
  const InputSide model_side = read_side({command.model, {}, model_reading, "--model-units"}, session);
  if (scan_side.input.model)
    throw Error("is a building model", command.scan, "give the scan first, then the model");
  if (!model_side.input.model)
    throw Error("is not a building model", command.model, "give an IFC, OBJ or PLY model");
  const BimModel& model = *model_side.input.model;
  const Scan scan = joined(scan_side.input);
  if (!scan.centre_known())
    session.note(
        "the scanner position is unknown, so missing elements cannot be found: give it with --origin");
  report.scan = scan_side.summary;
  report.model = model_side.summary;
  check_inputs(command, pose_file, report);
  for (const std::string& registered_scan : {pose_file.source_path, pose_file.target_path})
    note_other_scan(registered_scan, command.scan, session);
  put_in_metres(pose_file, command, report);
  report.measured = command.measuring;
  const Rigid3 pose = to_local(report.model_from_scan, scan.local_origin, model.local_origin);
  report.deviation = measure_deviation(scan, model, pose, command.measuring, *session.monitor);
  session.monitor->throw_if_cancelled();
  session.monitor->begin_stage("writing");
  write_deviation(folder.path(), report, model, scan, command.colour_limit_m);
  session.say(summary(report, model, command.folder));
  if (!command.issues.file.empty())
    session.say(fmt::format("{} issues written to {}\n", write_issues(command, report, scan, model),
                            command.issues.file));
  session.answer(deviation_json(report, model));
  return status_of_matched(report.deviation.matched, session);
}

void add_pose_options(CommandLine& command, DeviationCommand& options) {
  command.add_option("--result FILE", options.result,
                     "result.json of limen register, or a text file with a 4 x 4 matrix");
  command.add_flag("--identity", options.identity, "Scan and model are in one frame already");
  add_alternative_option(command, options.alternative);
  command.add_flag("--force", options.force,
                   "Accept files that are not the registered ones, for example copies in the same frame");
  command.add_flag("--inverse", options.inverse, "The pose in --result moves the model to the scan");
  command
      .add_option("--with SCAN POSE", options.with,
                  "A further scan and the file of its pose in SCAN's frame; may be given several times")
      ->type_size(2);
  command.add_option("--origin x,y,z", options.origin,
                     "Scanner position of SCAN, in the coordinates of its points");
  add_units_option(command, options.reading.units);
  add_units_option(command, options.model_units, "model-");
  add_memory_option(command, options.reading.memory);
  add_trajectory_options(command, options.reading);
}

}  // namespace

void add_deviation_command(CommandLine& app, Session& session) {
  auto options = std::make_shared<DeviationCommand>();
  CommandLine* command =
      add_command(app, session, "deviation", "Measure how a registered scan deviates from its model",
                  [options, &session] { return run(*options, session); });
  command
      ->add_option(
          "SCAN", options->scan,
          "A scan of any format limen reads; or the project.json of limen project, for all of its scans")
      ->required();
  command->add_option(
      "MODEL", options->model,
      "The building model: IFC, OBJ, or PLY with faces; for a project by default its own models");
  command
      ->add_option(
          "--model MODEL", options->models,
          "For a project: measure against this model; may be given several times, for files of one building")
      ->type_size(1)
      ->take_all();
  command
      ->add_option("-o,--output DIR", options->folder,
                   "Folder for deviation.json, deviation.csv, deviation.xlsx and deviation.ply; for a "
                   "project also report.html")
      ->required();
  add_pose_options(*command, *options);
  add_length_option(*command, "--max-distance-m", options->measuring.max_distance_m,
                    "Points farther than this from every face do not belong to the model (default 0.10)");
  add_length_option(*command, "--tile-m", options->measuring.tile_m,
                    "Size of the tiles by which coverage is counted (default 0.05)");
  add_length_option(*command, "--colour-limit-m", options->colour_limit_m,
                    "Deviation that is shown in full colour in deviation.ply (default 0.05)");
  command
      ->add_option(
          "--cloud-points", options->cloud_points,
          "For a project: maximum number of points in deviation.ply, spread evenly (default 3000000)")
      ->in_range(1000, 1000000000);
  add_issue_options(*command, options->issues);
  add_cover_options(*command, options->cover);
  add_pdf_option(*command, options->pdf);
}

}  // namespace limen
