// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "limen/base/angles.h"
#include "limen/base/atomic_file.h"
#include "limen/base/error.h"
#include "limen/base/folder_lock.h"
#include "limen/base/system.h"
#include "limen/base/text.h"
#include "limen/cli/commands/commands.h"
#include "limen/cli/inputs/cover_option.h"
#include "limen/cli/inputs/frame_system.h"
#include "limen/cli/inputs/known_decision.h"
#include "limen/cli/inputs/project_trajectories.h"
#include "limen/cli/inputs/scan_options.h"
#include "limen/cli/inputs/start_option.h"
#include "limen/files/mapped_file.h"
#include "limen/files/scan_in_file.h"
#include "limen/io/cloud/open_points.h"
#include "limen/project/project.h"
#include "limen/project/run/work.h"
#include "limen/project/state/scan_names.h"
#include "limen/project/state/words.h"
#include "limen/report/json/json_values.h"
#include "limen/report/project/project_json.h"
#include "limen/report/project/project_page.h"
#include "limen/report/project/project_sheets.h"
#include "limen/report/project/question_pictures.h"
#include "limen/report/project/read_project.h"
#include "limen/report/project/station_accuracy.h"

namespace limen {
namespace {

struct ProjectCommandOptions {
  std::vector<std::string> scans;
  std::vector<std::string> models;
  std::string list;
  std::string folder;
  std::string gravity = "auto";
  std::string pairs = "auto";
  std::string memory;
  std::string control;
  std::string check;
  std::string targets;
  std::string spheres;
  std::string boards;
  std::string decisions;
  std::string poses;
  std::string file_sigma;
  std::string tolerance;
  CoverChoice cover;
  std::string crs;
  TrajectoryChoice trajectories;
  double risk = VerdictOptions{}.risk;
  double probable_risk = VerdictOptions{}.probable_risk;
  std::string repeats = "unknown";
  bool apart = false;
  bool rigid_passes = false;
  std::string engine = "local";
  EngineOptions dask;
  bool pdf = false;
};

ProjectOptions project_options(const ProjectCommandOptions& options, const Session& session) {
  ProjectOptions project;
  project.registering.gravity = gravity_of(options.gravity);
  project.registering.seed = session.common.seed;
  ReadingChoice reading;
  reading.memory = options.memory;
  project.reading = with_choice(read_options("", "--origin", options.gravity), reading);
  project.registering.verdict.risk = options.risk;
  project.registering.verdict.probable_risk = options.probable_risk;
  project.registering.verdict.check();
  project.registering.nothing_repeats = options.repeats == "none";
  project.all_pairs = options.pairs == "all";
  project.stations_apart = options.apart;
  project.rigid_passes = options.rigid_passes;
  if (!options.file_sigma.empty()) project.file_sigma_m = length_of(options.file_sigma, "--trust-file-poses");
  if (!options.spheres.empty())
    project.targets.sphere_radius_m = length_of(options.spheres, "--sphere-radius");
  if (!options.boards.empty()) project.targets.board_side_m = length_of(options.boards, "--board-side");
  project.targets.check();
  project.engine = options.dask;
  project.engine.kind = options.engine == "dask" ? EngineKind::dask : EngineKind::local;
  project.on_note = [&session](const std::string& text) { session.note(text); };
  project.engine.on_note = project.on_note;
  return project;
}

OptionList reported(const ProjectCommandOptions& options, const Session& session) {
  OptionList list = {{"gravity", options.gravity}, {"pairs", options.pairs}};
  if (options.apart) list.emplace_back("stations_apart", true);
  if (options.rigid_passes) list.emplace_back("rigid_passes", true);
  if (options.risk != VerdictOptions{}.risk) list.emplace_back("risk", options.risk);
  if (options.probable_risk != VerdictOptions{}.probable_risk)
    list.emplace_back("probable_risk", options.probable_risk);
  if (options.repeats != "unknown") list.emplace_back("repeats", options.repeats);
  if (!options.memory.empty()) list.emplace_back("memory", options.memory);
  if (!options.control.empty()) list.emplace_back("control", options.control);
  if (!options.check.empty()) list.emplace_back("check", options.check);
  if (!options.targets.empty()) list.emplace_back("targets", options.targets);
  if (!options.spheres.empty()) list.emplace_back("sphere_radius", options.spheres);
  if (!options.boards.empty()) list.emplace_back("board_side", options.boards);
  if (!options.decisions.empty()) list.emplace_back("decide", options.decisions);
  if (!options.poses.empty()) list.emplace_back("poses", options.poses);
  if (!options.file_sigma.empty()) list.emplace_back("trust_file_poses", options.file_sigma);
  if (!options.tolerance.empty()) list.emplace_back("tolerance", options.tolerance);
  if (!options.crs.empty()) list.emplace_back("crs", options.crs);
  list.emplace_back("seed", static_cast<std::int64_t>(session.common.seed));
  return list;
}

std::string accuracy_text(const ProjectResult& result, std::size_t number) {
  const std::optional<StationAccuracy> it = accuracy_of(result, number);
  if (!it) return {};
  if (it->held_fixed) return "  (held fixed)";
  const PoseSigma& sigma = result.scans[number].sigma;
  std::string text = fmt::format("  (sigma {:.1f} mm, {:.3f} deg", 1e3 * sigma.translation_m.maxCoeff(),
                                 degrees(sigma.rotation_rad.maxCoeff()));
  if (it->within_tolerance)
    text +=
        fmt::format("; {:.1f} mm with 95 %: {}", 1e3 * it->radius_m, *it->within_tolerance ? "pass" : "fail");
  return text + ")";
}

std::string scan_line(const ProjectResult& result, std::size_t number) {
  const ProjectScan& scan = result.scans[number];
  std::string line =
      fmt::format("{:<17} {}", scan.readable ? to_string(scan.state) : "unreadable", scan_name(scan));
  const bool placed = scan.state == NodeState::registered || scan.state == NodeState::probable;
  if (scan.readable && placed) line += accuracy_text(result, number);
  if (!scan.readable || scan.state != NodeState::registered) line += ": " + scan.reason;
  line += "\n";
  if (scan.correction) {
    double most = 0.0;
    for (const PassKnot& knot : scan.correction->knots) most = std::max(most, knot.moved_m.norm());
    line += fmt::format("{:<17} drift corrected along {:.0f} m, by {:.1f} mm at most\n", "",
                        scan.correction->knots.back().distance_m, 1e3 * most);
  } else if (scan.component >= 0 && !scan.rigid.empty()) {
    line += fmt::format("{:<17} {}\n", "", scan.rigid);
  }
  return line;
}

/// Control and check points, a line each.
std::string point_lines(const ProjectResult& result) {
  if (result.control_file.empty() && result.points.empty()) return {};
  std::string text;
  if (!result.control_words.empty()) text += fmt::format("control     {}\n", result.control_words);
  for (const ProjectPoint& point : result.points) {
    if (!point.given) continue;
    text += fmt::format("{:<7} {:<12} {:<10}", to_string(point.role), point.name, to_string(point.state));
    if (point.found)
      text += fmt::format(" residual {:6.1f} {:6.1f} {:6.1f} mm (sigma {:.1f} {:.1f} {:.1f})",
                          1e3 * point.test.residual.x(), 1e3 * point.test.residual.y(),
                          1e3 * point.test.residual.z(), 1e3 * point.test.sigma.x(),
                          1e3 * point.test.sigma.y(), 1e3 * point.test.sigma.z());
    if (point.state == PointState::left_out || point.state == PointState::not_placed)
      text += ": " + point.reason;
    text += "\n";
  }
  return text;
}

std::string summary(const ProjectResult& result, const std::string& folder) {
  std::string text = fmt::format("{}: {}\n", to_string(result.outcome), result.reason);
  for (std::size_t k = 0; k < result.scans.size(); ++k) text += scan_line(result, k);
  text += point_lines(result);
  for (const ProjectDecision& stated : result.decisions)
    text += fmt::format("decision    {}: {}{}{}\n", words_of(stated.decision), to_string(stated.state),
                        stated.reason.empty() ? "" : ", ", stated.reason);
  for (const ProjectQuestion& question : result.questions) {
    text += "question: " + question.text + "\n";
    for (const Decision& answer : question.answers) {
      if (answer.kind != DecisionKind::forget) text += "  " + decide_line(folder, answer) + "\n";
    }
  }
  std::size_t counts[6] = {};
  for (const ProjectLink& link : result.links) ++counts[static_cast<std::size_t>(link.solved.state)];
  text += fmt::format(
      "links       {} verified, {} unchecked (bridge), {} ambiguous, {} rejected, {} weak, {} measured "
      "in place, of {} pairs tried\n",
      counts[0], counts[1], counts[2], counts[3], counts[4], counts[5], result.pairs_tried);
  if (const std::optional<BundleError> bundle = bundle_error(result))
    text += fmt::format("bundle      {:.1f} mm RMS of {} pairs of planes; the worst link {:.1f} mm\n",
                        1e3 * bundle->rms_m, bundle->planes, 1e3 * bundle->worst_rms_m);
  return text + fmt::format("written to {}\n", folder);
}

int status_of(ProjectOutcome outcome) {
  switch (outcome) {
    case ProjectOutcome::registered:
      return kExitOk;
    case ProjectOutcome::partial:
      return kExitUndecided;
    case ProjectOutcome::no_match:
      break;
  }
  return kExitNoMatch;
}

/// "9 files: 3 ready, 6 unreadable"
std::string file_counts(const ProjectStatus& status) {
  std::string text = fmt::format("{} files: {} ready", status.scans, status.ready);
  if (status.copies > 0)
    text += fmt::format(", {} {}", status.copies, status.copies == 1 ? "copy" : "copies");
  if (status.unreadable > 0) text += fmt::format(", {} unreadable", status.unreadable);
  return text;
}

int tell_status(const std::string& folder, const Session& session) {
  const ProjectStatus status = project_status(folder);
  Json json = {{"stage", status.stage},
               {"files", status.scans},
               {"files_ready", status.ready},
               {"files_copies", status.copies},
               {"files_unreadable", status.unreadable},
               {"pairs", status.pairs},
               {"pairs_tried", status.tried}};
  session.say(fmt::format("stage {}: {}; {} of {} pairs tried\n", status.stage, file_counts(status),
                          status.tried, status.pairs));
  session.answer(to_text(json));
  return kExitOk;
}

/// Words: decide, the folder, and the decision.
int take_decision(const std::vector<std::string>& words, const Session& session) {
  const Decision decision = as_known(decision_from({words.begin() + 2, words.end()}), words[1]);
  const bool forgets = decision.kind == DecisionKind::forget;
  const std::size_t before = kept_decisions(words[1], {}).size();
  const std::vector<Decision> all = decide(words[1], decision, full_names(words[1]));
  const char* stated =
      !forgets               ? "{}: saved; decisions in all: {}; run the project again to apply and test it\n"
      : all.size() == before ? "{}: no such decision was saved; decisions in all: {}, unchanged\n"
                             : "{}: forgotten; decisions left: {}; run the project again\n";
  session.say(fmt::format(fmt::runtime(stated), words_of(decision), all.size()));
  session.answer(decisions_text(all));
  return kExitOk;
}

/// Throws Error for a file in the format of one maker's programs.
void refuse_vendors(const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    const std::string file = file_of_scan(name);
    std::error_code ignored;
    if (has_vendor_ending(file) && std::filesystem::exists(file, ignored))
      static_cast<void>(point_format_of(MappedFile(file).bytes(), file));
  }
}

/// The files of a folder that are probably its scans: those of the ending that most have.
std::string scans_in(const std::filesystem::path& folder) {
  static const std::set<std::string> kEndings = {".e57", ".las", ".laz", ".ply",
                                                 ".pcd", ".ptx", ".pts", ".xyz"};
  std::map<std::string, int> count;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    const std::string ending = entry.path().extension().string();
    if (entry.is_regular_file(ignored) && kEndings.count(ending) > 0) ++count[ending];
  }
  const auto most = std::max_element(count.begin(), count.end(),
                                     [](const auto& a, const auto& b) { return a.second < b.second; });
  return shell_word(folder.string()) + "/*" + (most == count.end() ? "" : most->first);
}

/// A scan that cannot be read does not stop the others; where there is nothing else nothing is begun.
void require_files(const ProjectCommandOptions& options) {
  refuse_vendors(options.scans);
  refuse_vendors(options.models);
  std::error_code ignored;
  bool any = options.scans.empty();
  for (const std::string& scan : options.scans) {
    if (std::filesystem::is_directory(scan, ignored))
      throw Error("is a folder, not a scan", scan, "name the scans in it: " + scans_in(scan));
    any = any || std::filesystem::exists(file_of_scan(scan), ignored);
  }
  if (!any) static_cast<void>(MappedFile(options.scans.front()));  // says why
}

/// A job ends with the worker that started it, however that ends: LIMEN_WORKER_PID names it.
void die_with_worker() {
  const char* worker = std::getenv("LIMEN_WORKER_PID");
  if (worker == nullptr) return;
  if (!end_with_parent(worker))
    throw Error("the worker that started this job is gone", "LIMEN_WORKER_PID", "unset it", Fault::cancelled);
}

/// Words: work, the folder, and the job.
int work(const std::vector<std::string>& words, const Session& session) {
  die_with_worker();
  const WorkAnswer answer = do_work({words.begin() + 1, words.end()}, *session.monitor);
  session.say(fmt::format("{} {}\n", answer.state, answer.words));
  session.answer(to_text(Json{{"state", answer.state}, {"words", answer.words}}));
  return kExitOk;
}

ProjectInputs inputs_of(const ProjectCommandOptions& options) {
  return {options.scans,   options.models, options.control,  options.check,
          options.targets, options.poses,  options.decisions};
}

void refuse_to_replace_inputs(const ProjectCommandOptions& options, const std::filesystem::path& folder) {
  std::vector<std::string> inputs = {options.control, options.check, options.poses,
                                     options.targets, options.list,  options.decisions};
  for (const auto* files : {&options.scans, &options.models, &options.trajectories.files})
    inputs.insert(inputs.end(), files->begin(), files->end());
  std::vector<const char*> own = {"project.json", "links.csv", "stations.csv", "tables.xlsx", "report.html"};
  if (!options.spheres.empty() || !options.boards.empty()) own.push_back("targets.csv");
  refuse_same_files(folder, own, inputs);
}

/// Where nothing was kept that a later run could use, a folder is left as it was found.
bool keeps_nothing(const std::filesystem::path& folder) {
  std::error_code stop;
  std::filesystem::recursive_directory_iterator entry(folder, stop);
  for (; !stop && entry != std::filesystem::recursive_directory_iterator(); entry.increment(stop)) {
    const std::filesystem::path name = entry->path().filename();
    if (!entry->is_directory(stop) && name != "status.json" && name != "dask.log" &&
        name != FolderLock::kFile)
      return false;
  }
  return !stop;
}

ProjectResult run_in(const std::filesystem::path& folder, const ProjectCommandOptions& options,
                     const StatedTrajectories& trajectories, const Session& session) {
  ProjectOptions project = project_options(options, session);
  project.trajectories = trajectories;
  static_cast<void>(
      read_trajectories(trajectories));  // what is wrong with them is an error before the long work
  try {
    return run_project(inputs_of(options), folder, project, *session.monitor);
  } catch (...) {
    std::error_code ignored;
    if (keeps_nothing(folder)) std::filesystem::remove_all(folder / "store", ignored);
    throw;
  }
}

std::vector<ProjectPicture> pictures_in(const std::filesystem::path& folder,
                                        const ProjectCommandOptions& options,
                                        const StatedTrajectories& trajectories, const Session& session,
                                        const ProjectResult& result) {
  ProjectOptions project = project_options(options, session);
  project.trajectories = trajectories;
  return project_pictures(folder, project, result, kMostProjectPoints);
}

/// What a run leaves in its folder: the name and the text of each file, project.json last.
std::vector<std::pair<std::string, std::string>> files_of(const ProjectResult& result,
                                                          std::vector<ProjectPicture> pictures,
                                                          const std::string& json, const ReportCover& cover,
                                                          bool georeferenced) {
  std::vector<std::pair<std::string, std::string>> files;
  const std::vector<std::string> drawn = question_pictures(result, pictures);
  for (std::size_t k = 0; k < drawn.size(); ++k) {
    if (!drawn[k].empty()) files.emplace_back(fmt::format("question_{}.svg", k + 1), drawn[k]);
  }
  files.emplace_back("report.html", project_page(result, std::move(pictures), georeferenced, cover));
  const std::vector<Sheet> sheets = {stations_sheet(result), links_sheet(result), bundle_sheet(result),
                                     loops_sheet(result), points_sheet(result)};
  files.emplace_back("stations.csv", csv_of(sheets[0]));
  files.emplace_back("links.csv", csv_of(sheets[1]));
  files.emplace_back("tables.xlsx", workbook_of(sheets));
  files.emplace_back("project.json", json);
  return files;
}

/// Writes none of the files where one has no room. Then pictures and the printed report of an earlier run go.
void replace_files(const std::filesystem::path& folder,
                   const std::vector<std::pair<std::string, std::string>>& files, const Session& session) {
  std::vector<FileToWrite> written;
  for (const auto& [name, text] : files) written.push_back({folder / name, text});
  write_files(written);
  std::vector<std::string> earlier = {"report.pdf"};
  for (std::size_t number = 1; number <= kMostPictures; ++number)
    earlier.push_back(fmt::format("question_{}.svg", number));
  for (const std::string& name : earlier) {
    if (std::any_of(files.begin(), files.end(), [&](const auto& file) { return file.first == name; }))
      continue;
    std::error_code fault;
    std::filesystem::remove(folder / name, fault);
    if (fault)
      session.note(
          fmt::format("{} is of an earlier run and could not be removed: close it and remove it by hand",
                      (folder / name).string()));
  }
}

int run(ProjectCommandOptions options, const Session& session) {
  if (options.folder.empty() && options.scans.size() == 2 && options.scans.front() == "status")
    return tell_status(options.scans.back(), session);
  if (options.folder.empty() && options.scans.size() > 2 && options.scans.front() == "decide")
    return take_decision(options.scans, session);
  if (options.folder.empty() && options.scans.size() > 2 && options.scans.front() == "work")
    return work(options.scans, session);
  if (options.folder.empty() && !options.scans.empty() &&
      (options.scans.front() == "status" || options.scans.front() == "decide"))
    throw Error(fmt::format("project {} is incomplete", options.scans.front()), "",
                "write limen project status DIR, or limen project decide DIR accept A B");
  if (options.folder.empty()) throw Error("no output folder is given", "--output", "give one: -o DIR");
  if (!options.list.empty()) {
    for (std::string& name : names_in_list(options.list)) options.scans.push_back(std::move(name));
  }
  require_files(options);
  const std::filesystem::path browser = browser_for_pdf(options.pdf);
  const ReportCover cover = cover_of(options.cover);
  const CoordinateSystem chosen = chosen_system(options.crs);
  const std::optional<double> tolerance_m =
      options.tolerance.empty() ? std::nullopt : std::optional(length_of(options.tolerance, "--tolerance"));
  const OutputFolder folder(options.folder);
  const FolderLock lock(folder.path(), "another limen is working in this folder",
                        "wait until it has finished, or give another folder");
  refuse_to_replace_inputs(options, folder.path());
  const StatedTrajectories trajectories = stated_trajectories(options.trajectories, chosen);
  ProjectResult result = run_in(folder.path(), options, trajectories, session);
  result.tolerance_m = tolerance_m;
  std::vector<std::string> of_system;
  FrameSystem system = frame_system(result, chosen, of_system);
  system.trajectories = trajectories;
  const std::string json = project_json(result, reported(options, session), system);
  session.monitor->throw_if_cancelled();
  std::vector<ProjectPicture> pictures = pictures_in(folder.path(), options, trajectories, session, result);
  replace_files(folder.path(),
                files_of(result, std::move(pictures), json, cover,
                         system.system.known() || result.frame_kind == "control"),
                session);
  if (options.pdf) write_pdf(browser, folder.path(), session);
  for (const std::string& note : of_system) session.note(note);
  session.say(summary(result, options.folder));
  session.answer(json);
  return status_of(result.outcome);
}

void add_engine_options(CommandLine& command, ProjectCommandOptions& options) {
  const std::string group = "More than one machine";
  EngineOptions& dask = options.dask;
  const auto add = [&](const char* name, std::string& value, const char* type, const char* text) {
    command.add_option(name, value, text)->type_name(type)->group(group);
  };
  command
      .add_option("--engine", options.engine,
                  "Where features and pairs are computed: local (default) or dask; the result is the same")
      ->one_of({"local", "dask"})
      ->group(group);
  add("--scheduler", dask.scheduler, "ADDRESS",
      "Dask's scheduler, tls://HOST:PORT; without one, workers on this machine are started");
  add("--scheduler-file", dask.scheduler_file, "FILE",
      "Dask's scheduler, given by the file that dask-scheduler --scheduler-file writes");
  add("--tls-ca", dask.tls_ca, "PEM", "Certificate of the authority that signed the scheduler's certificate");
  add("--tls-cert", dask.tls_cert, "PEM", "Client certificate to show to the scheduler");
  add("--tls-key", dask.tls_key, "PEM", "Private key of the client certificate");
  command
      .add_flag("--trust-network", dask.trust_network,
                "Connect to the scheduler without TLS: anybody who can reach it can run programs as you")
      ->group(group);
}

}  // namespace

void add_project_command(CommandLine& app, Session& session) {
  auto options = std::make_shared<ProjectCommandOptions>();
  CommandLine* command = add_command(app, session, "project",
                                     "Register any number of scans, and building models, in one frame; "
                                     "`project status DIR` shows the progress, `project decide DIR accept A "
                                     "B` saves a decision; exit status 0: all registered, 3: some, 4: none",
                                     [options, &session] { return run(*options, session); });
  command->add_option("SCAN", options->scans, "Scans, and models, in any order and any frames");
  command->add_option("--model MODEL", options->models, "A building model; may be given several times")
      ->type_size(1)
      ->take_all();
  command->add_option("--scans FILE", options->list, "A text file with the name of a scan on each line");
  command->add_option("-o,--output DIR", options->folder,
                      "Folder for project.json, report.html and data that later runs use again");
  command
      ->add_option("--pairs", options->pairs,
                   "Which pairs are tried: auto (default, those that may overlap) or all")
      ->one_of({"auto", "all"});
  command->add_flag("--stations-apart", options->apart,
                    "Ignore the poses that a file states for the scans in it");
  command->add_option(
      "--poses CSV", options->poses,
      "Approximate scanner positions, from satellites, a tablet or another program: file,x,y,z[,sigma]; "
      "scans that cannot meet are not compared, and wrong positions are noted");
  command->add_option("--trust-file-poses SIGMA", options->file_sigma,
                      "Take the poses that a file states for the scans in it as approximate, with this "
                      "uncertainty (1 sigma) of the positions, such as 0.5m; without it they are exact");
  command->add_option("--tolerance LENGTH", options->tolerance,
                      "Report of each station whether its position is known to this with 95 %, such as 6mm");
  command->add_flag("--rigid-passes", options->rigid_passes,
                    "Treat every mobile scan as rigid: no drift is corrected");
  command->add_option("--control CSV", options->control,
                      "Control points: name,x,y,z,sigma (or sigma_x,sigma_y,sigma_z); the project takes "
                      "their frame. A point named like a scan is the scanner position of that scan");
  command->add_option("--targets CSV", options->targets,
                      "Targets measured in the scans: name,scan,x,y,z,sigma; x,y,z as in the scan's own "
                      "file; for a mobile scan also time, in the seconds of its points");
  command->add_option("--sphere-radius LENGTH", options->spheres,
                      "Find spheres of this radius, such as 72.5mm, in the static scans and use them as "
                      "targets; written to DIR/targets.csv, which --targets reads");
  command->add_option("--board-side LENGTH", options->boards,
                      "The same for checkerboards of two dark and two bright squares: the side of the whole "
                      "board, such as 300mm");
  command->add_option("--check CSV", options->check,
                      "Check points, with the columns of --control: they are only compared, and their "
                      "residuals are reported");
  command->add_option(
      "--decide JSON", options->decisions,
      "Your decisions: accept, reject or choose a pose of a link, start, level, same-floor; saved in DIR");
  command->add_option("--risk P", options->risk,
                      "Report a scan as registered only if the probability that its pose is wrong is below "
                      "this (default 0.001)");
  command->add_option(
      "--probable-risk P", options->probable_risk,
      "Report a scan as probable if the probability that its pose is wrong is below this (default 0.05)");
  add_repeats_option(*command, options->repeats);
  add_engine_options(*command, *options);
  add_pdf_option(*command, options->pdf);
  add_cover_options(*command, options->cover);
  add_crs_option(*command, options->crs);
  add_trajectories_option(*command, options->trajectories);
  add_gravity_option(*command, options->gravity, true);
  add_memory_option(*command, options->memory);
}

}  // namespace limen
