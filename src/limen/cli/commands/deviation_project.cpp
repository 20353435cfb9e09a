// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/commands/deviation_project.h"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <memory>

#include <fmt/format.h>

#include "limen/base/atomic_file.h"
#include "limen/base/error.h"
#include "limen/cli/inputs/project_trajectories.h"
#include "limen/cli/inputs/registered_file.h"
#include "limen/cli/inputs/scan_options.h"
#include "limen/deviation/building_deviation.h"
#include "limen/deviation/join_models.h"
#include "limen/io/cloud/read_scan.h"
#include "limen/io/cloud/thin_cloud.h"
#include "limen/register/frame/scan_frame.h"
#include "limen/report/deviation/building_report.h"
#include "limen/report/deviation/deviation_report.h"
#include "limen/report/project/read_project.h"
#include "limen/report/summary/words.h"

namespace limen {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kCloudBytes = 600'000'000;  // that thinning the coloured cloud may take
constexpr std::size_t kPlacesOfPass = 200;          // of the scanner of a mobile pass

bool stands(const ProjectEntry& entry) {
  return entry.frame_from_scan && (entry.state == "registered" || entry.state == "probable");
}

/// The models that are measured against, with their places in the project's frame.
class ModelChoice {
 public:
  ModelChoice(const std::vector<ProjectEntry>& entries, const ProjectDeviation& command,
              const Session& session)
      : command_(command), session_(session) {
    for (const ProjectEntry& entry : entries) {
      if (entry.model) entries_.push_back(entry);
    }
  }

  [[nodiscard]] std::vector<BuildingModel> models() const {
    return command_.models.empty() ? of_project() : as_named();
  }

 private:
  [[nodiscard]] std::vector<BuildingModel> of_project() const {
    std::vector<BuildingModel> models;
    for (const ProjectEntry& entry : entries_) {
      if (stands(entry)) {
        require_registered_file(entry, command_.project, command_.force);
        models.push_back({entry.file, 0, *entry.frame_from_scan, "project"});
      } else {
        session_.note(fmt::format(
            "{}: {}, so it is not used; give it with --model if it is in one frame with another model",
            entry.file, entry.state));
      }
    }
    if (!models.empty()) return models;
    throw Error(
        "no model is registered in the project's frame", command_.project,
        "run limen project with --model, or give --model here if the model is in the project's frame");
  }

  [[nodiscard]] std::vector<BuildingModel> as_named() const {
    std::vector<BuildingModel> models;
    for (const std::string& path : command_.models) {
      const ProjectEntry* entry = entry_of(path);
      if (entry != nullptr && stands(*entry)) {
        ProjectEntry named = *entry;
        named.file = path;
        require_registered_file(named, command_.project, command_.force);
        models.push_back({path, 0, *entry->frame_from_scan, "project"});
        continue;
      }
      const ProjectEntry* other = any_placed();
      if (other != nullptr) {
        session_.note(
            fmt::format("{} has no pose of its own in the project: it is assumed to be in one frame with {}",
                        path, other->file));
        models.push_back({path, 0, *other->frame_from_scan, "with the first"});
      } else {
        session_.note(fmt::format(
            "{} is assumed to be in the project's frame: no model of the project has a pose", path));
        models.push_back({path, 0, {}, "in the frame"});
      }
    }
    return models;
  }

  [[nodiscard]] const ProjectEntry* entry_of(const std::string& path) const {
    for (const ProjectEntry& entry : entries_) {
      if (entry.file == path) return &entry;
    }
    for (const ProjectEntry& entry : entries_) {
      if (fs::path(entry.file).filename() == fs::path(path).filename()) return &entry;
    }
    return nullptr;
  }

  /// Of those that are named, else of the project.
  [[nodiscard]] const ProjectEntry* any_placed() const {
    for (const std::string& path : command_.models) {
      const ProjectEntry* entry = entry_of(path);
      if (entry != nullptr && stands(*entry)) return entry;
    }
    const auto found = std::find_if(entries_.begin(), entries_.end(), stands);
    return found == entries_.end() ? nullptr : &*found;
  }

  const ProjectDeviation& command_;
  const Session& session_;
  std::vector<ProjectEntry> entries_;
};

/// The scan with every point where it is in the coordinates of the first model, about its local origin.
Scan placed_scan(Scan scan, const ProjectEntry& entry, const Rigid3& model_from_frame,
                 const Vector3d& model_origin) {
  if (entry.bend && scan.times_s.size() != scan.size())
    throw Error("its points have no times, so its drift cannot be corrected", entry.file,
                "give the file that was registered");
  const Vector3d origin = scan.local_origin;
  const auto place = [&](const Vector3d& x, std::size_t i) -> Vector3d {
    Vector3d in_frame = *entry.frame_from_scan * (origin + x);
    if (entry.bend) in_frame = entry.bend->moved(in_frame, scan.times_s[i]);
    return model_from_frame * in_frame - model_origin;
  };
  for (std::size_t i = 0; i < scan.centres.size(); ++i) scan.centres[i] = place(scan.centres[i], i);
  for (std::size_t i = 0; i < scan.size(); ++i) scan.points[i] = place(scan.points[i], i);
  scan.local_origin = model_origin;
  return scan;
}

/// Gives a static scan the position that its points support, or none: rays from a wrong position show false
/// gaps.
void settle_place(Scan& scan, const Session& session) {
  if (scan.mobile()) return;
  const ScannerPlace place = find_scan_frame(scan, Gravity::automatic, *session.monitor).place;
  scan.centres.clear();
  if (place.source != PlaceSource::unknown) scan.centres.push_back(place.centre);
}

/// What becomes of the points: the coloured cloud.
class ColouredCloud {
 public:
  ColouredCloud(const ProjectDeviation& command, std::uint64_t expected)
      : thinner_(options_of(command), expected) {}

  void add(const LaidScan& laid, const Vector3d& origin) {
    std::vector<std::string> names = {"x", "y", "z", "deviation_m", "element"};
    for (std::size_t begin = 0; begin < laid.points.size(); begin += kStreamRows) {
      const std::size_t end = std::min(laid.points.size(), begin + kStreamRows);
      auto numbers = std::make_shared<std::vector<double>>();
      numbers->reserve((end - begin) * names.size());
      for (std::size_t i = begin; i < end; ++i) {
        const Vector3d x = origin + laid.points[i];
        numbers->insert(numbers->end(), {x.x(), x.y(), x.z(), static_cast<double>(laid.distance_m[i]),
                                         static_cast<double>(laid.element[i])});
      }
      thinner_.add(table_of_numbers(numbers, names));
    }
  }

  std::size_t write(const fs::path& path, double colour_limit_m) {
    const ThinnedCloud thinned = thinner_.finish();
    const RecordTable& table = thinned.table;
    constexpr std::size_t kColumns = 5;
    std::vector<double> numbers(kColumns * table.rows);
    for (std::size_t k = 0; k < kColumns; ++k)
      load_numbers(table, table.fields[k], {0, table.rows}, numbers.data() + k, kColumns);
    const auto point = [&](std::size_t i) -> DeviationPoint {
      const double* row = numbers.data() + kColumns * i;
      return {{row[0], row[1], row[2]}, static_cast<float>(row[3]), static_cast<std::int32_t>(row[4])};
    };
    write_deviation_points(path, table.rows, point, colour_limit_m);
    return table.rows;
  }

 private:
  static ThinOptions options_of(const ProjectDeviation& command) {
    ThinOptions options;
    options.most_points = static_cast<std::uint64_t>(command.cloud_points);
    options.memory_bytes = kCloudBytes;
    return options;
  }

  CloudThinner thinner_;
};

/// Everything that is gathered while scan after scan is read.
struct Gathering {
  BuildingReport report;
  std::vector<IssueModel> issue_models;
  std::vector<Vector3d> scanners;  ///< coordinates of the first model
  Rigid3 model_from_frame;
};

void read_models(const std::vector<ProjectEntry>& entries, const ProjectDeviation& command,
                 const Session& session, Gathering& all) {
  std::vector<BuildingModel> models = ModelChoice(entries, command, session).models();
  all.model_from_frame = inverse(models.front().frame_from_model);
  std::vector<PlacedModel> placed;
  for (BuildingModel& model : models) {
    PlacedModel it{read_model_input(model.path, session), all.model_from_frame * model.frame_from_model};
    if (&model == &models.front()) it.first_from_model = {};
    model.elements = it.model.elements.size();
    if (!command.issues.file.empty())
      all.issue_models.push_back(issue_model(model.path, it.model, inverse(it.first_from_model)));
    placed.push_back(std::move(it));
  }
  JoinedModel joined = join_models(placed);
  if (joined.doubled > 0)
    session.note(fmt::format("{} elements are in several models: they count once", joined.doubled));
  all.report.model = std::move(joined.model);
  all.report.model_of_element = std::move(joined.model_of_element);
  all.report.doubled = joined.doubled;
  all.report.models = std::move(models);
}

/// The scans that are measured; the others are reported.
std::vector<ProjectEntry> scans_of(const std::vector<ProjectEntry>& entries, const Session& session,
                                   Gathering& all) {
  std::vector<ProjectEntry> scans;
  for (const ProjectEntry& entry : entries) {
    if (entry.model) continue;
    std::string reason;
    if (!stands(entry)) reason = fmt::format("its state is {}", entry.state);
    if (!entry.copy_of.empty()) reason = fmt::format("it is a copy of {}", entry.copy_of);
    if (reason.empty()) {
      if (entry.state == "probable")
        session.warn(fmt::format("{}: its pose is only probable; the probability that it is right is {}",
                                 scan_name(entry), probability_words(1.0 - entry.doubt)));
      scans.push_back(entry);
    } else {
      session.note(fmt::format("{} is left out: {}", scan_name(entry), reason));
      all.report.left_out.push_back({entry.file, entry.index, reason});
    }
  }
  if (!scans.empty()) return scans;
  throw Error("no scan is registered or probable in the project's frame", "project.json",
              "see the project's report");
}

void remember_scanners(const Scan& scan, Gathering& all) {
  const std::size_t step = 1 + scan.centres.size() / kPlacesOfPass;
  for (std::size_t i = 0; i < scan.centres.size(); i += step)
    all.scanners.push_back(scan.local_origin + scan.centres[i]);
}

void measure_scans(const std::vector<ProjectEntry>& scans, const ProjectDeviation& command,
                   const Session& session, Gathering& all, ColouredCloud& cloud) {
  BuildingMeasurement measurement(all.report.model, command.measuring);
  const Trajectories trajectories = read_trajectories(read_project_trajectories(command.project));
  ReadOptions reading;
  reading.memory_bytes = parse_memory(command.memory);
  const Vector3d origin = all.report.model.local_origin;
  std::string checked;
  for (const ProjectEntry& entry : scans) {
    session.monitor->begin_stage("reading");
    if (entry.file != checked) require_registered_file(entry, command.project, command.force);
    checked = entry.file;
    Scan scan = read_one_scan(entry.file, static_cast<std::size_t>(entry.index), reading, *session.monitor);
    if (const Trajectory* trajectory = covering_trajectory(scan, trajectories))
      scan = with_trajectory(scan, *trajectory).scan;
    settle_place(scan, session);
    if (!scan.centre_known())
      session.note(
          fmt::format("{}: its scanner position is unknown, so it cannot show that elements are missing",
                      scan_name(entry)));
    scan = placed_scan(std::move(scan), entry, all.model_from_frame, origin);
    session.monitor->begin_stage("distances");
    const LaidScan laid = measurement.add(scan, {}, entry.sigma_m, *session.monitor);
    remember_scanners(scan, all);
    cloud.add(laid, origin);
    all.report.scans.push_back({entry.file, entry.index, entry.sigma_m, entry.bend != nullptr,
                                all.model_from_frame * *entry.frame_from_scan});
  }
  session.monitor->begin_stage("elements");
  all.report.deviation = measurement.finish();
}

std::string summary(const BuildingReport& report, const ProjectDeviation& command) {
  const BuildingDeviation& deviation = report.deviation;
  std::size_t count[3] = {0, 0, 0};
  std::size_t moved = 0;
  for (const ElementDeviation& it : deviation.elements) {
    ++count[static_cast<std::size_t>(it.presence)];
    moved += has_moved(it, command.issues.options.moved_m) ? 1 : 0;
  }
  std::string text =
      fmt::format("{} points of {} scans, {} on faces of {} model{}, {} far from all of them\n",
                  deviation.points, report.scans.size(), deviation.matched, report.models.size(),
                  report.models.size() == 1 ? "" : "s", deviation.far);
  text += fmt::format(
      "{} elements found, {} of them moved by more than {:.0f} mm; {} not found, {} not judged; {} objects "
      "not in the model\n",
      count[0], moved, 1e3 * command.issues.options.moved_m, count[1], count[2], deviation.unmodelled.size());
  if (!command.issues.file.empty())
    text += fmt::format("{} issues written to {}\n", report.issues_stated, command.issues.file);
  return text + fmt::format("written to {}\n", command.folder);
}

}  // namespace

bool names_project(const std::string& path) {
  return fs::path(path).filename() == "project.json";
}

int status_of_matched(std::size_t matched, const Session& session) {
  if (matched > 0) return kExitOk;
  session.warn(
      "no point lies on a face of the model, so nothing was measured: check that the pose belongs to these "
      "files, and check their units");
  return kExitNoMatch;
}

void refuse_to_replace(const std::vector<std::string>& inputs, const std::string& folder,
                       const std::string& issues) {
  const auto same = [](const fs::path& a, const fs::path& b) {
    std::error_code missing;
    return fs::weakly_canonical(fs::absolute(a), missing) == fs::weakly_canonical(fs::absolute(b), missing);
  };
  const std::vector<const char*> own = {"deviation.json", "deviation.csv", "deviation.xlsx",
                                        "deviation.ply",  "report.html",   "report.pdf"};
  refuse_same_files(folder, own, inputs);
  for (const char* name : own) {
    if (!issues.empty() && same(fs::path(folder) / name, issues))
      throw Error("is written by limen deviation itself", issues, "give the issues another name");
  }
  if (issues.empty()) return;
  for (const std::string& input : inputs) refuse_same_file(issues, input);
  const fs::path parent = fs::absolute(issues).parent_path();
  if (fs::is_directory(issues)) throw Error("is a folder, not a file", issues, "name a file to write to");
  if (same(issues, folder)) throw Error("is the output folder", issues, "name a file to write to");
  if (!fs::is_directory(parent) && !same(parent, folder))
    throw Error("there is no such folder", parent.string(), "make it, or write elsewhere");
}

int run_project_deviation(const ProjectDeviation& command, const Session& session) {
  command.measuring.check();
  command.issues.options.check();
  const CancelScope scope(*session.monitor);
  const std::vector<ProjectEntry> entries = read_project(command.project);
  std::vector<std::string> inputs = command.models;
  inputs.push_back(command.project);
  for (const ProjectEntry& entry : entries) inputs.push_back(entry.file);
  refuse_to_replace(inputs, command.folder, command.issues.file);
  std::error_code missing;
  if (fs::equivalent(command.folder, fs::absolute(command.project).parent_path(), missing))
    throw Error("is the folder of the project, whose report.html would be replaced", command.folder,
                "give another folder");
  const OutputFolder folder(command.folder);
  Gathering all;
  all.report.project = command.project;
  all.report.measured = command.measuring;
  all.report.issues = command.issues.options;
  const std::vector<ProjectEntry> scans = scans_of(entries, session, all);
  read_models(entries, command, session, all);
  ColouredCloud cloud(command, std::numeric_limits<std::uint32_t>::max());
  measure_scans(scans, command, session, all, cloud);
  session.monitor->begin_stage("writing");
  std::string issues;
  if (!command.issues.file.empty()) {
    const std::vector<BcfTopic> topics =
        deviation_issues({all.report.model, all.report.deviation.elements, all.report.deviation.unmodelled,
                          all.issue_models, all.report.model_of_element, all.scanners},
                         command.issues.options);
    all.report.issues_stated = topics.size();
    issues = bcf_file(topics, date_of_file(command.project));
  }
  for (const char* old : {"deviation.json", "report.pdf"}) fs::remove(folder.path() / old);
  all.report.cloud_points = cloud.write(folder.path() / "deviation.ply", command.colour_limit_m);
  if (!issues.empty()) write_file(command.issues.file, issues);
  const std::string json = building_json(all.report);
  const Sheet table = building_sheet(all.report);
  const std::string page = building_page(all.report, command.cover);
  write_files({{folder.path() / "deviation.csv", csv_of(table)},
               {folder.path() / "deviation.xlsx", workbook_of({table})},
               {folder.path() / "report.html", page},
               {folder.path() / "deviation.json", json}});
  session.say(summary(all.report, command));
  session.answer(json);
  return status_of_matched(all.report.deviation.matched, session);
}

}  // namespace limen
