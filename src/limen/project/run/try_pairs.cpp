// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/run/try_pairs.h"

#include <mutex>

#include <fmt/format.h>

#include "limen/base/parallel.h"
#include "limen/project/retrieve/choose_pairs.h"
#include "limen/project/run/work.h"
#include "limen/project/state/scan_names.h"
#include "limen/register/judge/given_pose.h"

namespace limen {
namespace {

// Of a placement that no search refined: deviations add up from scan to scan.
constexpr double kPlacementM = 0.1;

class ScanQuery {
 public:
  ScanQuery(const std::vector<ProjectNode>& nodes, const RegisterOptions& options, ScanCache& cache)
      : nodes_(&nodes), options_(&options), cache_(&cache) {}

  [[nodiscard]] PoseSurface surface(int source, int target, const Rigid3& target_from_source) const {
    if (!meet(source, target, target_from_source)) return {};
    const PoseScore score =
        score_given_pose(*cache_->get(node(source).key), *cache_->get(node(target).key),
                         world_pose(source, target, target_from_source), options_->method, kPlacementM);
    return {score.agreeing_m2, score.contradicted_m2};
  }

  [[nodiscard]] std::optional<LookAlikeEvidence> things(int source, int target,
                                                        const Rigid3& target_from_source) const {
    if (!meet(source, target, target_from_source)) return std::nullopt;
    return look_alike_of_given_pose(*cache_->get(node(source).key), *cache_->get(node(target).key),
                                    world_pose(source, target, target_from_source),
                                    look_alike_options(options_->nothing_repeats));
  }

 private:
  [[nodiscard]] const ProjectNode& node(int n) const { return (*nodes_)[static_cast<std::size_t>(n)]; }
  [[nodiscard]] bool is_station(int n) const {
    if (static_cast<std::size_t>(n) >= nodes_->size()) return false;  // that of a survey
    const ScanDigest& digest = node(n).digest;
    return !digest.mobile && !digest.model && !digest.stations.empty();
  }
  [[nodiscard]] bool meet(int source, int target, const Rigid3& target_from_source) const {
    return is_station(source) && is_station(target) &&
           box_of_planes(node(source).digest, target_from_source)
               .intersects(box_of_planes(node(target).digest, {}));
  }
  [[nodiscard]] Rigid3 world_pose(int source, int target, const Rigid3& target_from_source) const {
    return to_world(target_from_source, node(source).digest.local_origin, node(target).digest.local_origin);
  }

  const std::vector<ProjectNode>* nodes_;
  const RegisterOptions* options_;
  ScanCache* cache_;
};

}  // namespace

PoseQuery query_of_scans(const std::vector<ProjectNode>& nodes, const RegisterOptions& options,
                         ScanCache& cache) {
  const ScanQuery scans(nodes, options, cache);
  return {[scans](int source, int target, const Rigid3& pose) { return scans.surface(source, target, pose); },
          [scans](int source, int target, const Rigid3& pose) { return scans.things(source, target, pose); }};
}

namespace {

constexpr std::size_t kScansInMemory = 16;

}  // namespace

bool seem_level(const ProjectNode& source, const ProjectNode& target, const RegisterOptions& options) {
  const auto level = [](const ScanDigest& digest) { return digest.upright && !digest.model; };
  const bool sure = source.digest.surely_upright && target.digest.surely_upright;
  return options.gravity == Gravity::automatic && !sure && level(source.digest) && level(target.digest);
}

namespace {

/// Those of the pairs that are not kept are made by the engine: per pair why there is no result.
std::vector<std::string> made_elsewhere(const std::vector<std::pair<std::size_t, std::size_t>>& pairs,
                                        const std::vector<PairKey>& keys, const PairWork& work,
                                        ProjectStatus& status, Monitor& monitor) {
  std::vector<std::string> faults(keys.size());
  std::vector<Job> jobs;
  std::vector<std::size_t> places;
  for (std::size_t k = 0; k < keys.size(); ++k) {
    // Few pairs have a start, by a user or by the other links: they are made here, and workers need not know
    // of starts.
    if (keys[k].start || work.store.has_pair(keys[k].source, keys[k].target_name(), keys[k].counts)) continue;
    const auto name = [&](std::size_t node) { return scan_name(work.scans[work.nodes[node].scan]); };
    jobs.push_back(pair_job(work.folder, name(pairs[k].first) + " and " + name(pairs[k].second), keys[k]));
    places.push_back(k);
  }
  const std::size_t kept = keys.size() - jobs.size();
  const std::size_t before = status.tried;
  const auto on_done = [&](std::size_t done) {
    status.tried = before + kept + done;
    write_status(work.folder, status);
    monitor.advance(static_cast<double>(kept + done), static_cast<double>(keys.size()));
  };
  const std::vector<JobResult> results = work.engine->run(jobs, on_done, monitor);
  status.tried = before;
  for (std::size_t k = 0; k < results.size(); ++k) {
    if (results[k].state != JobState::done) faults[places[k]] = results[k].words;
  }
  return faults;
}

}  // namespace

std::vector<TriedPair> try_pairs(const std::vector<std::pair<std::size_t, std::size_t>>& pairs,
                                 const PairWork& work, PairSearch search, ProjectStatus& status,
                                 Monitor& monitor) {
  monitor.begin_stage("pairs");
  status.stage = "pairs";
  std::vector<TriedPair> tried(pairs.size());
  std::vector<PairKey> keys(pairs.size());
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const ProjectNode& source = work.nodes[pairs[k].first];
    const ProjectNode& target = work.nodes[pairs[k].second];
    tried[k] = {pairs[k].first, pairs[k].second, {}, {}};
    const auto start = work.starts.find(pairs[k]);
    keys[k] = {source.key,
               target.key,
               search == PairSearch::level && seem_level(source, target, work.options),
               start == work.starts.end() ? std::nullopt : std::optional(start->second),
               {source.digest.counts(), target.digest.counts()}};
  }
  std::vector<std::string> faults(pairs.size());
  if (work.engine != nullptr) faults = made_elsewhere(pairs, keys, work, status, monitor);
  ScanCache cache(work.store, kScansInMemory, names_of_keys(work.nodes, work.scans));
  std::mutex mutex;
  std::size_t done = 0;
  parallel_for(pairs.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      tried[k].fault = faults[k];
      if (faults[k].empty()) tried[k].result = make_pair_result(keys[k], work.options, work.store, cache);
      const std::lock_guard<std::mutex> lock(mutex);
      ++status.tried;
      if (work.engine == nullptr) write_status(work.folder, status);
      monitor.advance(static_cast<double>(++done), static_cast<double>(pairs.size()));
    }
  });
  write_status(work.folder, status);
  return tried;
}

}  // namespace limen
