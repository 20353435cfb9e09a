// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/project.h"

#include <algorithm>
#include <memory>

#include <fmt/format.h>

#include "limen/base/atomic_file.h"
#include "limen/base/error.h"
#include "limen/base/named.h"
#include "limen/base/progress.h"
#include "limen/io/cloud/point_print.h"
#include "limen/io/trajectory/read_trajectory.h"
#include "limen/model/plausible_size.h"
#include "limen/project/assemble.h"
#include "limen/project/control/control_file.h"
#include "limen/project/inputs/project_files.h"
#include "limen/project/retrieve/choose_pairs.h"
#include "limen/project/run/loose_pairs.h"
#include "limen/project/run/prepare_files.h"
#include "limen/project/run/store_jobs.h"
#include "limen/project/run/try_pairs.h"
#include "limen/project/run/waves.h"
#include "limen/project/run/work.h"
#include "limen/project/solve/own_drift.h"
#include "limen/project/solve/project_graph.h"
#include "limen/project/state/project_node.h"
#include "limen/project/state/scan_names.h"
#include "limen/project/survey/found_targets.h"
#include "limen/project/survey/stated_place.h"

namespace limen {
namespace {

constexpr int kPairsPerScan = 12;  // that are tried at most, on average, where not all are

class Run {
 public:
  Run(const ProjectInputs& inputs, std::filesystem::path folder, const ProjectOptions& options,
      Monitor& monitor)
      : inputs_(inputs),
        folder_(std::move(folder)),
        options_(options),
        monitor_(monitor),
        store_(folder_ / "store", store_options(options), monitor),
        engine_(make_engine(options.engine, (folder_ / "store" / "dask.log").string(), monitor)),
        files_(list_files(inputs, monitor)),
        decisions_(kept_decisions(folder_, inputs.decisions,
                                  [this](const std::string& name) { return files_.full_name(name); })) {}

  ProjectResult run() {
    for (const std::string& text : files_.notes) note(text);
    count_files();
    if (engine_) prepare_elsewhere();
    prepare_all();
    if (nodes_.empty()) {
      const ProjectScan& first = result_.scans.front();
      throw Error("no scan could be read; the first: " + first.reason, first.file, "check the files");
    }
    note_lone_scan();
    note_copies();
    note_unused_trajectories();
    take_stated();
    order_nodes();
    name_found_targets();
    learn_own_drift(nodes_);
    words_ = words_by_nodes(decisions_, nodes_, result_.scans);
    std::vector<TriedPair> tried = few() ? try_all(every_pair()) : waves();
    try_named(tried);
    try_last(tried);
    engine_.reset();
    monitor_.begin_stage("adjustment");
    result_.pairs_tried = static_cast<std::size_t>(
        std::count_if(tried.begin(), tried.end(), [](const TriedPair& pair) { return !pair.placed; }));
    ScanCache queried(store_, kQueriedInMemory, names_of_keys(nodes_, result_.scans));
    const std::size_t noted = result_.notes.size();
    assemble(nodes_, tried, inputs_, words_, options_.registering.verdict,
             query_of_scans(nodes_, options_.registering, queried), result_);
    compare_with_stated(nodes_, result_);
    for (std::size_t k = noted; options_.on_note && k < result_.notes.size(); ++k)
      options_.on_note(result_.notes[k]);
    if (options_.rigid_passes) {
      for (ProjectScan& scan : result_.scans)
        scan.rigid = scan.mobile ? "treated as rigid, as you asked" : "";
    }
    status_.stage = "done";
    // Some were tried twice: as scans that stand upright and any way round, or in their place.
    status_.pairs = status_.tried = result_.pairs_tried;
    write_status(folder_, status_);
    return std::move(result_);
  }

 private:
  void note(std::string text) {
    if (options_.on_note) options_.on_note(text);
    result_.notes.push_back(std::move(text));
  }

  /// Control points alone can place one scan; else there is nothing to be done.
  void note_lone_scan() {
    if (nodes_.size() == 1 && inputs_.control.empty())
      note(fmt::format(
          "{} is the only scan, so there is nothing to register it to; give more scans, or a model",
          scan_name(result_.scans[nodes_.front().scan])));
  }

  /// Files of equal bytes are taken as one; a copy in another format, or with fewer points, is a scan of its
  /// own, which says nothing new: the user has to decide.
  void note_copies() {
    const auto name = [&](std::size_t k) { return scan_name(result_.scans[nodes_[k].scan]); };
    for (std::size_t b = 0; b < nodes_.size(); ++b) {
      for (std::size_t a = 0; a < b; ++a) {
        if (nodes_[a].digest.model || nodes_[b].digest.model) continue;
        const auto [less, more] =
            std::minmax(a, b, [&](std::size_t i, std::size_t j) { return points_of(i) < points_of(j); });
        if (same_points(prints_[a], prints_[b]))
          note(fmt::format("{} and {} seem to hold the same {} points: leave one of them out", name(a),
                           name(b), points_of(a)));
        else if (points_of(less) < points_of(more) && is_part_of(prints_[less], prints_[more]))
          note(fmt::format(
              "{} holds only points of {}, of which it seems a thinned copy or a part: leave one of them out",
              name(less), name(more)));
      }
    }
  }

  void note_unused_trajectories() {
    for (const std::string& file : options_.trajectories.files) {
      const std::string used = "was measured along " + file;
      if (std::any_of(result_.notes.begin(), result_.notes.end(),
                      [&](const std::string& text) { return text.ends_with(used); }))
        continue;
      const Trajectory trajectory = read_trajectory(file, options_.trajectories.reading);
      note(
          fmt::format("{}: no scan was measured along this trajectory: none has most of its times between "
                      "{:.1f} and {:.1f} s, or its points are far away",
                      file, trajectory.first_s(), trajectory.last_s()));
    }
  }

  [[nodiscard]] std::size_t points_of(std::size_t node) const {
    return result_.scans[nodes_[node].scan].points;
  }

  void count_files() {
    status_.scans = files_.files.size();
    for (const ProjectFile& file : files_.files) {
      if (!file.fault.empty()) {
        ++status_.unreadable;
      } else if (!file.copy_of.empty()) {
        ++status_.copies;
      }
    }
  }

  void prepare_all() {
    monitor_.begin_stage("features");
    status_.stage = "features";
    write_status(folder_, status_);
    prepare_files(files_.files, options_, store_, monitor_,
                  [this](std::size_t k, const FileOutcome& outcome) {
                    const ProjectFile& file = files_.files[k];
                    if (outcome.record) {
                      add_file(k, *outcome.record);
                      ++status_.ready;
                    } else if (!file.copy_of.empty()) {
                      add_copies(file);
                    } else if (!file.fault.empty()) {
                      add_unreadable(file, file.fault);
                    } else {
                      add_unreadable(file, stated_fault(file, outcome.fault));
                      ++status_.unreadable;
                    }
                    write_status(folder_, status_);
                  });
  }

  /// What is not kept is made by the engine's workers; what they could not make is the file's fault.
  void prepare_elsewhere() {
    monitor_.begin_stage("features");
    write_work_order(folder_, files_.files, options_, store_);
    std::vector<Job> jobs;
    std::vector<ProjectFile*> files;
    for (ProjectFile& file : files_.files) {
      if (!file.fault.empty() || !file.copy_of.empty() || kept_record(store_, file, options_)) continue;
      jobs.push_back(features_job(folder_, file, store_));
      files.push_back(&file);
    }
    status_.stage = "features";
    const std::size_t kept = files_.files.size() - jobs.size() - status_.copies - status_.unreadable;
    const auto on_done = [&](std::size_t done) {
      status_.ready = kept + done;
      write_status(folder_, status_);
      monitor_.advance(static_cast<double>(done), static_cast<double>(jobs.size()));
    };
    const std::vector<JobResult> results = engine_->run(jobs, on_done, monitor_);
    for (std::size_t k = 0; k < results.size(); ++k) {
      if (results[k].state == JobState::done) continue;
      files[k]->fault = stated_fault(*files[k], results[k].words);
      ++status_.unreadable;
    }
    status_.ready = 0;
  }

  static std::string stated_fault(const ProjectFile& file, const std::string& words) {
    const std::string named = file.path + ": ";  // said where the fault is
    const std::string fault = words.starts_with(named) ? words.substr(named.size()) : words;
    return "cannot be read: " +
           (lists_files(file.path) ? "it names other files; give it as --scans " + file.path : fault);
  }

  void add_unreadable(const ProjectFile& file, const std::string& fault) {
    // Of one file alone it is the error that ends the run.
    if (options_.on_note && files_.files.size() > 1) options_.on_note(file.path + ": " + fault);
    ProjectScan scan;
    scan.file = file.path;
    scan.sha256 = file.sha256;
    scan.model = file.model;
    scan.readable = false;
    scan.reason = fault;
    result_.scans.push_back(std::move(scan));
  }

  /// Copies are where the file is that they are copies of; their places are filled in later.
  void add_copies(const ProjectFile& file) {
    for (std::size_t k = 0, count = result_.scans.size(); k < count; ++k) {
      if (result_.scans[k].file != file.copy_of) continue;
      ProjectScan copy = result_.scans[k];
      copy.file = file.path;
      copy.copy_of = file.copy_of;
      result_.scans.push_back(std::move(copy));
    }
  }

  void add_file(std::size_t number, const FileRecord& record) {
    const ProjectFile& file = files_.files[number];
    for (const std::string& text : record.notes) note(file.path + ": " + text);
    const std::size_t first = nodes_.size();
    for (std::size_t k = 0; k < record.points.size(); ++k) {
      ProjectNode node;
      node.scan = result_.scans.size();
      node.file = number;
      node.key = store_.feature_key(file.key(), static_cast<int>(k));
      const std::optional<ScanDigest> digest = store_.load_digest(node.key);
      if (!digest)
        throw Error("its features cannot be read back from the store", file.path, "check the disk");
      node.digest = *digest;
      if (const std::string hint = up_hint(digest->upright_from_scan.row(2).transpose());
          digest->upright && !digest->model && !hint.empty())
        note(file.path + ": " + hint);
      if (options_.rigid_passes) node.digest.track.way = {};
      ProjectScan scan;
      scan.file = file.path;
      scan.index = static_cast<int>(k);
      scan.several = record.points.size() > 1;
      scan.sha256 = file.sha256;
      scan.model = file.model;
      scan.mobile = node.digest.mobile;
      scan.points = record.points[k];
      result_.scans.push_back(std::move(scan));
      nodes_.push_back(std::move(node));
      prints_.push_back(k < record.prints.size() ? record.prints[k] : PointPrint{});
    }
    settle_group(first);
  }

  /// Scans of one file are known to one another where their scanners stood in different places of it.
  void settle_group(std::size_t first) {
    if (options_.stations_apart || nodes_.size() - first < 2) return;
    for (std::size_t i = first; i < nodes_.size(); ++i) {
      const ScanDigest& digest = nodes_[i].digest;
      if (digest.stations.empty()) return;
      for (std::size_t j = first; j < i; ++j) {
        const Vector3d apart = digest.local_origin + digest.stations.front() - nodes_[j].digest.local_origin -
                               nodes_[j].digest.stations.front();
        if (apart.norm() < kOnePlaceM) return;
      }
    }
    for (std::size_t i = first; i < nodes_.size(); ++i) nodes_[i].grouped = true;
  }

  void take_stated() {
    std::vector<std::string> notes;
    const std::vector<SurveyedPoint> positions =
        inputs_.poses.empty() ? std::vector<SurveyedPoint>{} : read_stated_positions(inputs_.poses);
    take_stated_positions(positions, options_.file_sigma_m, result_.scans, nodes_, notes);
    for (std::string& text : notes) note(std::move(text));
  }

  /// What was found in the scans is written as a user would have measured it, and read like that.
  void name_found_targets() {
    if (!options_.targets.any()) return;
    std::vector<TargetsOfScan> scans;
    for (const ProjectNode& node : nodes_) {
      if (const auto targets = store_.load_targets(node.key, options_.targets); targets && !node.digest.model)
        scans.push_back({scan_name(result_.scans[node.scan]), *targets});
    }
    const TargetTable table = table_of_targets(scans, inputs_);
    inputs_.targets = (folder_ / "targets.csv").string();
    write_file(inputs_.targets, table.text);
    note(table.words);
  }

  /// The first is the one whose world becomes the frame, if it can be.
  void order_nodes() {
    const auto rank = [](const ProjectNode& node) {
      return node.digest.mobile ? 0 : node.digest.model ? 1 : node.grouped ? 2 : 3;
    };
    std::stable_sort(nodes_.begin(), nodes_.end(),
                     [&](const ProjectNode& a, const ProjectNode& b) { return rank(a) < rank(b); });
  }

  [[nodiscard]] double risk() const { return options_.registering.verdict.risk; }

  [[nodiscard]] bool few() const {
    return options_.all_pairs || nodes_.size() <= static_cast<std::size_t>(kPairsPerScan) + 1;
  }

  std::vector<TriedPair> try_all(const PairList& pairs, PairSearch search = PairSearch::level) {
    return try_all(pairs, search, words_.starts);
  }
  std::vector<TriedPair> try_all(const PairList& pairs, PairSearch search, const PairStarts& starts) {
    status_.pairs += pairs.size();
    const PairWork work{nodes_, result_.scans, store_, options_.registering, starts, engine_.get(), folder_};
    std::vector<TriedPair> tried = try_pairs(pairs, work, search, status_, monitor_);
    for (const TriedPair& pair : tried) {
      if (pair.fault.empty()) continue;
      const auto name = [&](std::size_t node) { return scan_name(result_.scans[nodes_[node].scan]); };
      note(fmt::format("{} and {} could not be compared ({}); run again to try once more", name(pair.source),
                       name(pair.target), pair.fault));
    }
    return tried;
  }

  std::vector<TriedPair> waves() {
    return try_in_waves(nodes_, words_, risk(), kPairsPerScan,
                        [this](const PairList& pairs) { return try_all(pairs); });
  }

  /// Pairs that a user names are tried in any case.
  void try_named(std::vector<TriedPair>& tried) {
    PairList named;
    const auto name = [&](const std::pair<std::size_t, std::size_t>& wanted) {
      const bool known = std::any_of(tried.begin(), tried.end(), [&](const TriedPair& other) {
        return std::pair(other.source, other.target) == wanted;
      });
      if (!known) named.push_back(wanted);
    };
    for (const auto& [pair, start] : words_.starts) name(pair);
    for (const auto& [pair, word] : words_.pairs) {
      if (word.kind != DecisionKind::reject && words_.starts.count(pair) == 0) name(pair);
    }
    for (TriedPair& pair : try_all(named)) tried.push_back(std::move(pair));
    std::sort(tried.begin(), tried.end(), by_nodes);
  }

  /// What is tried last, by where all scans are by now.
  void try_last(std::vector<TriedPair>& tried) {
    ProjectGraph made = make_graph(nodes_, tried, words_);
    SolvedGraph solved = solve_graph(made.graph, risk());
    if (try_any_turn(solved, tried)) {
      made = make_graph(nodes_, tried, words_);
      solved = solve_graph(made.graph, risk());
    }
    measure_in_place(loose_pairs(nodes_, made, words_, solved), tried);
  }

  /// Scans that seem to stand upright may not: those that nothing holds are tried once more, any way round.
  bool try_any_turn(const SolvedGraph& solved, std::vector<TriedPair>& tried) {
    PairList again;
    std::vector<std::size_t> places;
    for (std::size_t k = 0; k < tried.size(); ++k) {
      const TriedPair& pair = tried[k];
      const bool alone = solved.nodes[pair.source].component < 0 || solved.nodes[pair.target].component < 0;
      if (!alone || pair.result.outcome != Outcome::no_match || !pair.fault.empty()) continue;
      if (!seem_level(nodes_[pair.source], nodes_[pair.target], options_.registering)) continue;
      again.emplace_back(pair.source, pair.target);
      places.push_back(k);
    }
    std::vector<TriedPair> results = try_all(again, PairSearch::any_turn);
    for (std::size_t k = 0; k < results.size(); ++k) tried[places[k]] = std::move(results[k]);
    return !again.empty();
  }

  /// Scans that are held only loosely to one another are measured from where all links place them.
  void measure_in_place(const std::vector<LoosePair>& loose, std::vector<TriedPair>& tried) {
    PairList pairs;
    PairStarts starts;
    for (const LoosePair& pair : loose) {
      pairs.emplace_back(pair.source, pair.target);
      starts.emplace(pairs.back(), start_in_place(pair));
    }
    std::vector<TriedPair> measured = try_all(pairs, PairSearch::level, starts);
    for (std::size_t k = 0; k < loose.size(); ++k) {
      measured[k].placed = loose[k].placed;
      tried.push_back(std::move(measured[k]));
    }
  }

  [[nodiscard]] StartPrior start_in_place(const LoosePair& pair) const {
    constexpr double kLeastM = 0.05;
    constexpr double kLeastRad = 0.005;
    const Vector6d sigma = pair.placed.covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
    StartPrior start;
    start.target_from_source =
        to_world(pair.placed.target_from_source, nodes_[pair.source].digest.local_origin,
                 nodes_[pair.target].digest.local_origin);
    start.sigma_m = std::max(kLeastM, sigma.tail<3>().maxCoeff());
    start.sigma_rad = std::max(kLeastRad, sigma.head<3>().maxCoeff());
    return start;
  }

  [[nodiscard]] PairList every_pair() const {
    PairList pairs;
    for (std::size_t source = 0; source < nodes_.size(); ++source) {
      for (std::size_t target = 0; target < source; ++target) {
        if (nodes_[source].digest.model && nodes_[target].digest.model) continue;
        if (!options_.all_pairs && !can_meet(nodes_[source], nodes_[target])) continue;
        pairs.emplace_back(source, target);
      }
    }
    return pairs;
  }

  static constexpr double kOnePlaceM = 0.05;
  static constexpr std::size_t kQueriedInMemory = 32;

  ProjectInputs inputs_;
  std::filesystem::path folder_;
  const ProjectOptions& options_;
  Monitor& monitor_;
  Store store_;
  std::unique_ptr<JobEngine> engine_;  ///< null: the local one
  ProjectFiles files_;
  std::vector<Decision> decisions_;
  UserWords words_;
  ProjectStatus status_;
  std::vector<ProjectNode> nodes_;
  std::vector<PointPrint> prints_;  ///< of the nodes, as they were read
  ProjectResult result_;
};

}  // namespace

void ProjectOptions::check() const {
  registering.check();
  reading.check();
  engine.check();
  targets.check();
  if (file_sigma_m && !(*file_sigma_m > 0.0)) throw_bad_option("file_sigma_m", *file_sigma_m, "more than 0");
}

const char* to_string(ProjectOutcome outcome) {
  static constexpr Named<ProjectOutcome> names[] = {{ProjectOutcome::registered, "registered"},
                                                    {ProjectOutcome::partial, "partial"},
                                                    {ProjectOutcome::no_match, "no_match"}};
  return name_of(names, outcome);
}

ProjectResult run_project(const ProjectInputs& inputs, const std::filesystem::path& folder,
                          const ProjectOptions& options, Monitor& monitor) {
  options.check();
  if (inputs.scans.empty()) throw Error("there is no scan", "project", "give at least one");
  if (options.targets.any() && !inputs.targets.empty())
    throw Error("targets are given, and others are to be found", inputs.targets,
                "give the file alone, or without it the sizes of the targets");
  // A fault in a small file is an error before hours of work.
  for (const std::string& file : {inputs.control, inputs.check}) {
    if (!file.empty()) static_cast<void>(read_surveyed_points(file));
  }
  if (!inputs.decisions.empty()) static_cast<void>(read_decisions(inputs.decisions));
  if (!inputs.targets.empty()) static_cast<void>(read_seen_targets(inputs.targets));
  if (!inputs.poses.empty()) static_cast<void>(read_stated_positions(inputs.poses));
  const CancelScope scope(monitor);
  return Run(inputs, folder, options, monitor).run();
}

}  // namespace limen
