// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "limen/base/atomic_file.h"
#include "limen/base/error.h"
#include "limen/cli/commands/commands.h"
#include "limen/cli/inputs/cover_option.h"
#include "limen/cli/inputs/register_inputs.h"
#include "limen/cli/inputs/scan_options.h"
#include "limen/cli/inputs/start_option.h"
#include "limen/register/register.h"
#include "limen/report/html/html_report.h"
#include "limen/report/json/result_json.h"
#include "limen/report/summary/summary_text.h"

namespace limen {
namespace {

struct RegisterCommandOptions {
  std::string source;
  std::string target;
  std::string folder;
  std::string method = "auto";
  std::string as_published;
  std::string gravity = "auto";
  std::string origin;
  std::string source_origin;
  std::string target_origin;
  std::vector<std::string> source_with;
  std::vector<std::string> target_with;
  std::string start;
  std::string start_sigma;
  std::vector<std::string> start_points;
  std::string repeats = "unknown";
  double wall_thickness_m = 0.0;
  double risk = VerdictOptions{}.risk;
  double probable_risk = VerdictOptions{}.probable_risk;
  bool no_report = false;
  bool pdf = false;
  CoverChoice cover;
  std::string memory;
  ReadingChoice source_reading;
  ReadingChoice target_reading;
};

/// A registration and what its page draws.
struct Registered {
  RegistrationReport report;
  ReportScene scene;
};

/// What is left of a side to tell of and to draw, once its scans are given up.
struct StatedSide {
  InputSummary summary;
  SceneSide scene;
};

/// The options of one side: what is said of it alone counts before what is said of both.
ReadOptions side_options(const RegisterCommandOptions& options, const std::string& own,
                         const std::string& name, ReadingChoice reading) {
  reading.memory = options.memory;
  return with_choice(own.empty() ? read_options(options.origin, "--origin", options.gravity)
                                 : read_options(own, name, options.gravity),
                     reading);
}

std::string spaced(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

OptionList reported(const RegisterCommandOptions& options) {
  OptionList list = {{"method", options.method}, {"gravity", options.gravity}};
  if (!options.as_published.empty()) list.emplace_back("as_published", options.as_published);
  if (!options.origin.empty()) list.emplace_back("origin", options.origin);
  if (!options.source_origin.empty()) list.emplace_back("source_origin", options.source_origin);
  if (!options.target_origin.empty()) list.emplace_back("target_origin", options.target_origin);
  if (!options.source_with.empty()) list.emplace_back("source_with", spaced(options.source_with));
  if (!options.target_with.empty()) list.emplace_back("target_with", spaced(options.target_with));
  if (!options.source_reading.units.empty()) list.emplace_back("source_units", options.source_reading.units);
  if (!options.target_reading.units.empty()) list.emplace_back("target_units", options.target_reading.units);
  if (!options.memory.empty()) list.emplace_back("memory", options.memory);
  if (!options.source_reading.trajectory.empty())
    list.emplace_back("source_trajectory", options.source_reading.trajectory);
  if (!options.target_reading.trajectory.empty())
    list.emplace_back("target_trajectory", options.target_reading.trajectory);
  if (!options.start.empty()) list.emplace_back("start", options.start);
  if (!options.start_sigma.empty()) list.emplace_back("start_sigma", options.start_sigma);
  if (!options.start_points.empty()) list.emplace_back("start_points", spaced(options.start_points));
  if (options.repeats != "unknown") list.emplace_back("repeats", options.repeats);
  if (options.wall_thickness_m > 0) list.emplace_back("wall_thickness_m", options.wall_thickness_m);
  if (options.risk != VerdictOptions{}.risk) list.emplace_back("risk", options.risk);
  if (options.probable_risk != VerdictOptions{}.probable_risk)
    list.emplace_back("probable_risk", options.probable_risk);
  return list;
}

/// Two lists of segments are registered as such by any method that could mean them.
bool takes_segments(const RegisterCommandOptions& options) {
  if (options.method != "segments" && options.method != "auto") return false;
  if (!are_segment_files(options.source, options.target)) return false;
  if (!options.as_published.empty()) {
    throw Error("published methods register scans, not lists of segments", "--as-published",
                "leave the option out, or give scans as SOURCE and TARGET");
  }
  if (options.source_with.empty() && options.target_with.empty()) return true;
  throw Error("two lists of segments are registered as they are, without further scans",
              options.source_with.empty() ? "--target-with" : "--source-with",
              "leave the option out, or give scans as SOURCE and TARGET");
}

Registered register_files(const RegisterCommandOptions& options, const Session& session) {
  const ReadOptions source_options =
      side_options(options, options.source_origin, "--source-origin", options.source_reading);
  const ReadOptions target_options =
      side_options(options, options.target_origin, "--target-origin", options.target_reading);
  VerdictOptions verdict;
  verdict.risk = options.risk;
  verdict.probable_risk = options.probable_risk;
  verdict.check();
  const std::optional<StartPrior> believed =
      start_of(options.start, options.start_sigma, options.start_points,
               [&] { return unit_of_input(options.target, target_options.metres_per_unit); });
  RegisterOptions registering;
  registering.gravity = gravity_of(options.gravity);
  registering.method = value_called(kMethods, options.method).value();
  registering.as_published = value_called(kPublishedMethods, options.as_published);
  registering.wall_thickness_m = options.wall_thickness_m;
  registering.verdict = verdict;
  registering.start = believed;
  registering.nothing_repeats = options.repeats == "none";
  registering.seed = session.common.seed;
  registering.picture = !options.no_report;
  StatedSide source;
  StatedSide target;
  SamePointsWatch watch(options.source, options.target);
  const auto reader = [&](const SideOptions& side, StatedSide& stated) {
    return [&session, &stated, &watch, side, is_source = &stated == &source, drawn = registering.picture] {
      InputSide read = read_side(side, session);
      if (const std::string note = watch.note_on(read.input, is_source); !note.empty()) session.note(note);
      stated.summary = std::move(read.summary);
      if (drawn) stated.scene = scene_side(read.input);
      return std::move(read.input);
    };
  };
  Registered registered;
  RegistrationReport& report = registered.report;
  report.result =
      register_inputs(reader({options.source, options.source_with, source_options, "--source-units"}, source),
                      reader({options.target, options.target_with, target_options, "--target-units"}, target),
                      registering, *session.monitor);
  if (!watch.note().empty()) report.notes.push_back(watch.note());
  report.source = std::move(source.summary);
  report.target = std::move(target.summary);
  note_place(report.source, report.result.source_place, session);
  note_place(report.target, report.result.target_place, session);
  report.options = reported(options);
  report.seed = session.common.seed;
  if (const auto& picture = report.result.picture)
    registered.scene = {with_picture(std::move(source.scene), picture->source),
                        with_picture(std::move(target.scene), picture->target)};
  return registered;
}

Registered register_segment_lists(const RegisterCommandOptions& options, const Session& session) {
  Registered registered;
  registered.report =
      register_segment_files(options.source, options.target, gravity_of(options.gravity), session);
  registered.report.options = reported(options);
  if (const auto& picture = registered.report.result.picture)
    registered.scene = {with_picture({}, picture->source), with_picture({}, picture->target)};
  return registered;
}

/// The page, for which the numbers are not given up: where it has no room that is reported, and the status
/// stays that of the outcome.
void write_page(const std::filesystem::path& folder, const Registered& registered, const ReportCover& cover,
                const Session& session) {
  session.monitor->begin_stage("report");
  try {
    write_report(folder, registered.report, registered.scene, cover);
  } catch (const Error& error) {
    if (error.fault() != Fault::input) throw;
    session.warn(fmt::format(
        "the report could not be written: {}; result.json{} complete", error.what(),
        registered.report.result.outcome == Outcome::no_match ? " is" : " and transform.txt are"));
  }
}

/// The browser that is to print, found before the work; none where nothing is to be printed.
std::filesystem::path browser_of(const RegisterCommandOptions& options) {
  if (options.pdf && options.no_report)
    throw Error("--pdf prints the report that --no-report leaves out", "--pdf", "give one of them");
  return browser_for_pdf(options.pdf);
}

int status_of(Outcome outcome) {
  switch (outcome) {
    case Outcome::registered:
      return kExitOk;
    case Outcome::probable:
    case Outcome::ambiguous:
    case Outcome::under_constrained:
      return kExitUndecided;
    case Outcome::no_match:
      return kExitNoMatch;
  }
  return kExitInternal;
}

void refuse_to_replace_inputs(const RegisterCommandOptions& options, const std::filesystem::path& folder) {
  std::vector<std::string> inputs = {options.source, options.target};
  for (const auto* with : {&options.source_with, &options.target_with})
    inputs.insert(inputs.end(), with->begin(), with->end());
  refuse_same_files(folder, {"result.json", "transform.txt"}, inputs);
}

int run(const RegisterCommandOptions& options, const Session& session) {
  if (!options.as_published.empty() && options.method != "auto") {
    throw Error("--as-published and --method both choose a method", "--as-published " + options.as_published,
                "give one of them");
  }
  const std::filesystem::path browser = browser_of(options);
  const ReportCover cover = cover_of(options.cover);
  const bool segments = takes_segments(options);
  const OutputFolder folder(options.folder);
  refuse_to_replace_inputs(options, folder.path());
  const Registered registered =
      segments ? register_segment_lists(options, session) : register_files(options, session);
  const RegistrationReport& report = registered.report;
  const std::string json = result_json(report);
  session.monitor->throw_if_cancelled();
  remove_report(folder.path());  // an earlier run's page must not stand beside other numbers
  write_numbers(folder.path(), report);
  if (!options.no_report) write_page(folder.path(), registered, cover, session);
  if (options.pdf) write_pdf(browser, folder.path(), session);
  session.say(summary_text(report, options.folder));
  session.answer(json);
  return status_of(report.result.outcome);
}

void add_with_option(CommandLine& command, const char* name, std::vector<std::string>& with,
                     const char* side) {
  command
      .add_option(name, with,
                  fmt::format("Another scan whose pose in {0}'s frame is known, and the file of that pose (4 "
                              "x 4 matrix, or a result.json); may be given several times",
                              side))
      ->type_size(2)
      ->type_name("SCAN POSE")
      ->take_all();
}

void add_origin_options(CommandLine& command, RegisterCommandOptions& options) {
  const auto add = [&command](const char* name, std::string& text, const char* description) {
    command.add_option(name, text, description)->type_name("x,y,z");
  };
  add("--source-origin", options.source_origin,
      "Scanner position of SOURCE, in the coordinates of its points, metres");
  add("--target-origin", options.target_origin,
      "Scanner position of TARGET, in the coordinates of its points, metres");
  add("--origin", options.origin,
      "Scanner position of SOURCE and of TARGET, if its coordinates are the same in both, metres");
}

}  // namespace

void add_register_command(CommandLine& app, Session& session) {
  auto options = std::make_shared<RegisterCommandOptions>();
  CommandLine* command =
      add_command(app, session, "register",
                  "Find the pose of a scan in another scan or in a building model; exit status 0: "
                  "registered, 3: probable, ambiguous or under-constrained, 4: no match",
                  [options, &session] { return run(*options, session); });
  command->add_option("SOURCE", options->source, "The scan, model or list of segments to be moved")
      ->required();
  command->add_option("TARGET", options->target, "The scan, model or list of segments that stays")
      ->required();
  command
      ->add_option("-o,--output DIR", options->folder,
                   "Folder for report.html, result.json and transform.txt")
      ->required();
  command
      ->add_option("--method", options->method,
                   "What to match: auto (default), polygons, openings, hybrid (both), or segments")
      ->one_of(names_in(kMethods));
  command
      ->add_option("--as-published", options->as_published,
                   "Use the method of a published paper instead, for comparison: one pose and no verdict, "
                   "exit status 3")
      ->one_of(names_in(kPublishedMethods));
  add_length_option(
      *command, "--wall-thickness-m,--wall-thickness", options->wall_thickness_m,
      "Thickness of the outer walls, if it is known; else it is measured, or reported as not determined");
  command->add_option("--risk P", options->risk,
                      "Report `registered` only if the probability that the pose is wrong (a look-alike "
                      "place, another pose, chance) is below this (default 0.001)");
  command->add_option(
      "--probable-risk P", options->probable_risk,
      "Report `probable` if the probability that the pose is wrong is below this (default 0.05)");
  command->add_option("--start POSE", options->start,
                      "Approximate pose: identity (both files are in one frame), or the file of a pose. It "
                      "is weighed against the scans, which may refute it");
  command->add_option("--start-sigma LENGTH,ANGLE", options->start_sigma,
                      "Standard deviation of --start: position and rotation (default 2m,5deg)");
  command
      ->add_option("--start-points X,Y,Z=X,Y,Z", options->start_points,
                   "Instead of --start: three or more places, each in SOURCE and in TARGET, in metres")
      ->take_list();
  add_repeats_option(*command, options->repeats);
  add_with_option(*command, "--source-with", options->source_with, "SOURCE");
  add_with_option(*command, "--target-with", options->target_with, "TARGET");
  add_pdf_option(*command, options->pdf);
  command->add_flag("--no-report", options->no_report,
                    "Write neither report.html nor the sections, only result.json and transform.txt");
  add_cover_options(*command, options->cover);
  add_gravity_option(*command, options->gravity, true);
  add_origin_options(*command, *options);
  add_units_option(*command, options->source_reading.units, "source-");
  add_units_option(*command, options->target_reading.units, "target-");
  add_memory_option(*command, options->memory);
  add_trajectory_options(*command, options->source_reading, "source-");
  add_trajectory_options(*command, options->target_reading, "target-");
}

}  // namespace limen
