// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/project.h"

#include <algorithm>
#include <set>
#include <tuple>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/base/stage_part.h"
#include "limen/bim/read_bim.h"
#include "limen/io/cloud/read_scan.h"
#include "limen/project/control/control_file.h"
#include "limen/project/project_files.h"
#include "limen/project/project_graph.h"
#include "limen/project/project_state.h"
#include "limen/project/retrieve/choose_pairs.h"
#include "limen/register/prepare/prepare_model.h"

namespace limen {
namespace {

/// Everything that features and pairs depend on beside the files.
std::string options_text(const ProjectOptions& options) {
  const RegisterOptions& registering = options.registering;
  std::string text = fmt::format("method {} gravity {} thickness {} seed {} level {} memory {}",
                                 static_cast<int>(registering.method), static_cast<int>(registering.gravity),
                                 registering.wall_thickness_m, registering.seed, options.reading.level,
                                 options.reading.memory_bytes);
  return text;
}

class Run {
 public:
  Run(const ProjectInputs& inputs, std::filesystem::path folder, const ProjectOptions& options,
      Monitor& monitor)
      : inputs_(inputs),
        folder_(std::move(folder)),
        options_(options),
        monitor_(monitor),
        store_(folder_ / "store", options_text(options)),
        files_(list_files(inputs, monitor)),
        decisions_(kept_decisions(folder_, inputs.decisions)) {}

  ProjectResult run() {
    result_.notes = files_.notes;
    status_.scans = files_.files.size();
    prepare_files();
    if (nodes_.empty()) {
      const ProjectScan& first = result_.scans.front();
      throw Error("no scan could be read; the first " + first.reason, first.file, "look at the files");
    }
    order_nodes();
    words_ = words_by_nodes(decisions_, nodes_, result_.scans);
    std::vector<TriedPair> tried = few() ? try_all(every_pair()) : try_in_waves();
    try_named(tried);
    try_any_turn(tried);
    monitor_.begin_stage("adjustment");
    result_.pairs_tried = tried.size();
    assemble(nodes_, tried, inputs_, words_, risk(), result_);
    if (options_.rigid_passes) {
      for (ProjectScan& scan : result_.scans) scan.rigid = scan.mobile ? "as you asked" : "";
    }
    status_.stage = "done";
    write_status(folder_, status_);
    return std::move(result_);
  }

 private:
  void prepare_files() {
    monitor_.begin_stage("features");
    status_.stage = "features";
    write_status(folder_, status_);
    for (std::size_t k = 0; k < files_.files.size(); ++k) {
      monitor_.throw_if_cancelled();
      const ProjectFile& file = files_.files[k];
      const double all = static_cast<double>(files_.files.size());
      StagePart part(monitor_, static_cast<double>(k) / all, static_cast<double>(k + 1) / all);
      if (!file.fault.empty()) {
        add_unreadable(file, file.fault);
        continue;
      }
      if (!file.copy_of.empty()) {
        add_copies(file);
        continue;
      }
      try {
        add_file(k, file.model ? model_record(file, part) : scan_record(file, part));
      } catch (const Error& error) {
        if (error.fault() != Fault::input) throw;
        add_unreadable(file, lists_files(file.path) ? "it names other files; give it as --scans " + file.path
                                                    : std::string(error.what()));
      }
      ++status_.ready;
      write_status(folder_, status_);
    }
  }

  void add_unreadable(const ProjectFile& file, const std::string& fault) {
    ProjectScan scan;
    scan.file = file.path;
    scan.sha256 = file.sha256;
    scan.model = file.model;
    scan.readable = false;
    scan.reason = "cannot be read: " + fault;
    result_.scans.push_back(std::move(scan));
  }

  /// Copies stand where the file stands that they are copies of; their places are filled in later.
  void add_copies(const ProjectFile& file) {
    for (std::size_t k = 0, count = result_.scans.size(); k < count; ++k) {
      if (result_.scans[k].file != file.copy_of) continue;
      ProjectScan copy = result_.scans[k];
      copy.file = file.path;
      copy.copy_of = file.copy_of;
      result_.scans.push_back(std::move(copy));
    }
  }

  [[nodiscard]] bool all_kept(const std::string& sha256, const FileRecord& record) const {
    for (std::size_t k = 0; k < record.points.size(); ++k) {
      const std::string key = store_.feature_key(sha256, static_cast<int>(k));
      if (!store_.has_features(key) || !store_.load_digest(key)) return false;
    }
    return true;
  }

  FileRecord scan_record(const ProjectFile& file, Monitor& part) {
    if (const std::optional<FileRecord> kept = store_.load_file(file.sha256)) {
      if (all_kept(file.sha256, *kept)) return *kept;
    }
    constexpr double kReading = 0.3;
    ScanFile read;
    {
      StagePart reading(part, 0.0, kReading);
      read = read_scan_file(file.path, options_.reading, reading);
    }
    FileRecord record;
    record.notes = read.notes;
    const auto all = static_cast<double>(read.scans.size());
    for (std::size_t k = 0; k < read.scans.size(); ++k) {
      const auto at = [&](std::size_t i) {
        return kReading + (1.0 - kReading) * static_cast<double>(i) / all;
      };
      StagePart preparing(part, at(k), at(k + 1));
      record.points.push_back(read.scans[k].size());
      const Scan scan = std::move(read.scans[k]);
      PrepareOptions with_track = prepare_options(options_.registering);
      with_track.track = true;
      store_.save_features(store_.feature_key(file.sha256, static_cast<int>(k)),
                           prepare_scan(scan, with_track, preparing));
    }
    store_.save_file(file.sha256, record);
    return record;
  }

  FileRecord model_record(const ProjectFile& file, Monitor& part) {
    if (const std::optional<FileRecord> kept = store_.load_file(file.sha256)) {
      if (all_kept(file.sha256, *kept)) return *kept;
    }
    const BimModel model = read_bim(file.path, part);
    store_.save_features(store_.feature_key(file.sha256, 0), prepare_model(model, {}, part));
    FileRecord record{{0}, model.warnings};
    store_.save_file(file.sha256, record);
    return record;
  }

  void add_file(std::size_t number, const FileRecord& record) {
    const ProjectFile& file = files_.files[number];
    for (const std::string& note : record.notes) result_.notes.push_back(file.path + ": " + note);
    const std::size_t first = nodes_.size();
    for (std::size_t k = 0; k < record.points.size(); ++k) {
      ProjectNode node;
      node.scan = result_.scans.size();
      node.file = number;
      node.key = store_.feature_key(file.sha256, static_cast<int>(k));
      const std::optional<ScanDigest> digest = store_.load_digest(node.key);
      if (!digest) throw Error("features cannot be read back", folder_.string(), "look at the disk");
      node.digest = *digest;
      if (options_.rigid_passes) node.digest.track.way = {};
      ProjectScan scan;
      scan.file = file.path;
      scan.index = static_cast<int>(k);
      scan.sha256 = file.sha256;
      scan.model = file.model;
      scan.mobile = node.digest.mobile;
      scan.points = record.points[k];
      result_.scans.push_back(std::move(scan));
      nodes_.push_back(std::move(node));
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
    return options_.all_pairs || nodes_.size() <= static_cast<std::size_t>(options_.pairs_per_scan) + 1;
  }

  std::vector<TriedPair> try_all(const PairList& pairs, PairSearch search = PairSearch::level) {
    status_.pairs += pairs.size();
    // What is kept of a pair does not depend on the risk: the project weighs it.
    RegisterOptions registering = options_.registering;
    registering.verdict.risk = VerdictOptions{}.risk;
    return try_pairs(pairs, nodes_, store_, registering, search, folder_, status_, monitor_);
  }

  /// Pairs that a user names are tried in any case.
  void try_named(std::vector<TriedPair>& tried) {
    PairList named;
    for (const auto& [pair, word] : words_.pairs) {
      const bool known = std::any_of(tried.begin(), tried.end(), [&, wanted = pair](const TriedPair& other) {
        return std::pair(other.source, other.target) == wanted;
      });
      if (!known && word.kind != DecisionKind::reject) named.push_back(pair);
    }
    for (TriedPair& pair : try_all(named)) tried.push_back(std::move(pair));
    std::sort(tried.begin(), tried.end(), by_nodes);
  }

  static bool by_nodes(const TriedPair& a, const TriedPair& b) {
    return std::pair(a.source, a.target) < std::pair(b.source, b.target);
  }

  /// Scans that seem to stand upright may not: those that nothing holds are tried once more, any way round.
  void try_any_turn(std::vector<TriedPair>& tried) {
    const SolvedGraph solved = solve_graph(make_graph(nodes_, tried, risk(), words_).graph, risk());
    PairList again;
    std::vector<std::size_t> places;
    for (std::size_t k = 0; k < tried.size(); ++k) {
      const TriedPair& pair = tried[k];
      const bool alone = solved.nodes[pair.source].component < 0 || solved.nodes[pair.target].component < 0;
      if (!alone || pair.result.outcome != Outcome::no_match) continue;
      if (!seem_level(nodes_[pair.source], nodes_[pair.target], options_.registering)) continue;
      again.emplace_back(pair.source, pair.target);
      places.push_back(k);
    }
    std::vector<TriedPair> results = try_all(again, PairSearch::any_turn);
    for (std::size_t k = 0; k < results.size(); ++k) tried[places[k]] = std::move(results[k]);
  }

  /// First the pairs whose planes promise most; then, where they led to poses, those that must see the same;
  /// for scans that are not held yet the next in their list.
  std::vector<TriedPair> try_in_waves() {
    std::vector<ScanDigest> digests;
    for (const ProjectNode& node : nodes_) digests.push_back(node.digest);
    const std::vector<std::vector<std::size_t>> ranked = ranked_partners(digests);
    std::vector<TriedPair> tried = try_all(best_pairs(ranked, kFirstPartners));
    const auto most = static_cast<std::size_t>(options_.pairs_per_scan) * nodes_.size();
    for (int wave = 1; wave <= kWaves; ++wave) {
      PairList next =
          next_pairs(ranked, tried, kFirstPartners + static_cast<std::size_t>(wave) * kMorePartners);
      if (tried.size() >= most) break;
      next.resize(std::min(next.size(), most - tried.size()));
      if (next.empty()) break;
      for (TriedPair& pair : try_all(next)) tried.push_back(std::move(pair));
    }
    std::sort(tried.begin(), tried.end(), by_nodes);
    return tried;
  }

  [[nodiscard]] PairList next_pairs(const std::vector<std::vector<std::size_t>>& ranked,
                                    const std::vector<TriedPair>& tried, std::size_t partners) const {
    const ProjectGraph made = make_graph(nodes_, tried, risk(), words_);
    const SolvedGraph solved = solve_graph(made.graph, risk());
    std::set<std::pair<std::size_t, std::size_t>> done;
    for (const TriedPair& pair : tried) done.emplace(pair.source, pair.target);
    std::vector<int> held(nodes_.size(), 0);
    for (std::size_t k = 0; k < made.graph.links.size(); ++k) {
      if (solved.links[k].state != LinkState::verified) continue;
      ++held[static_cast<std::size_t>(made.graph.links[k].source)];
      ++held[static_cast<std::size_t>(made.graph.links[k].target)];
    }
    // By how near they stand, then by name.
    std::vector<std::tuple<double, std::size_t, std::size_t>> wanted;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (done.count({i, j}) > 0 || solved.nodes[i].component < 0) continue;
        if (solved.nodes[i].component != solved.nodes[j].component) continue;
        const double apart = (solved.nodes[i].frame_from_node * nodes_[i].digest.middle -
                              solved.nodes[j].frame_from_node * nodes_[j].digest.middle)
                                 .norm();
        if (apart < kNearM && (held[i] < kEnoughLinks || held[j] < kEnoughLinks))
          wanted.emplace_back(apart, i, j);
      }
      if (held[i] > 0) continue;
      for (std::size_t k = 0; k < std::min(partners, ranked[i].size()); ++k) {
        const std::pair pair(std::max(i, ranked[i][k]), std::min(i, ranked[i][k]));
        if (done.count(pair) == 0) wanted.emplace_back(kNearM, pair.first, pair.second);
      }
    }
    std::sort(wanted.begin(), wanted.end());
    PairList next;
    for (const auto& [apart, i, j] : wanted) {
      if (done.emplace(i, j).second) next.emplace_back(i, j);
    }
    return next;
  }

  [[nodiscard]] PairList every_pair() const {
    PairList pairs;
    for (std::size_t source = 0; source < nodes_.size(); ++source) {
      for (std::size_t target = 0; target < source; ++target) {
        if (nodes_[source].digest.model && nodes_[target].digest.model) continue;
        pairs.emplace_back(source, target);
      }
    }
    return pairs;
  }

  static constexpr double kOnePlaceM = 0.05;
  static constexpr std::size_t kFirstPartners = 6;
  static constexpr std::size_t kMorePartners = 4;
  static constexpr int kWaves = 3;
  static constexpr double kNearM = 12.0;  // stations nearer than this may see the same
  static constexpr int kEnoughLinks = 4;  // verified ones: a scan that has them needs no more

  const ProjectInputs& inputs_;
  std::filesystem::path folder_;
  const ProjectOptions& options_;
  Monitor& monitor_;
  Store store_;
  ProjectFiles files_;
  std::vector<Decision> decisions_;
  UserWords words_;
  ProjectStatus status_;
  std::vector<ProjectNode> nodes_;
  ProjectResult result_;
};

}  // namespace

void ProjectOptions::check() const {
  registering.check();
  reading.check();
  if (pairs_per_scan < 1) throw_bad_option("pairs_per_scan", pairs_per_scan, "1 or more");
}

const char* to_string(ProjectOutcome outcome) {
  switch (outcome) {
    case ProjectOutcome::registered:
      return "registered";
    case ProjectOutcome::partial:
      return "partial";
    case ProjectOutcome::no_match:
      break;
  }
  return "no_match";
}

ProjectResult run_project(const ProjectInputs& inputs, const std::filesystem::path& folder,
                          const ProjectOptions& options, Monitor& monitor) {
  options.check();
  if (inputs.scans.empty()) throw Error("there is no scan", "project", "give at least one");
  // A fault in a small file is told before hours of work.
  for (const std::string& file : {inputs.control, inputs.check}) {
    if (!file.empty()) static_cast<void>(read_surveyed_points(file));
  }
  if (!inputs.decisions.empty()) static_cast<void>(read_decisions(inputs.decisions));
  if (!inputs.targets.empty()) static_cast<void>(read_seen_targets(inputs.targets));
  const CancelScope scope(monitor);
  return Run(inputs, folder, options, monitor).run();
}

}  // namespace limen
