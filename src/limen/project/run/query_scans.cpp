// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/run/query_scans.h"

#include <memory>

#include "limen/project/retrieve/predict_overlap.h"
#include "limen/register/judge/given_pose.h"

namespace limen {
namespace {

// Of a placement that no search refined: deviations add up from scan to scan.
constexpr double kPlacementM = 0.1;

class ScanHearing {
 public:
  ScanHearing(const std::vector<ProjectNode>& nodes, const RegisterOptions& options, ScanCache& cache)
      : nodes_(&nodes), options_(&options), cache_(&cache) {}

  [[nodiscard]] PoseHeard surface(int source, int target, const Rigid3& target_from_source) const {
    if (!meet(source, target, target_from_source)) return {};
    const PoseScore score =
        score_given_pose(*cache_->get(node(source).key), *cache_->get(node(target).key),
                         world_pose(source, target, target_from_source), options_->method, kPlacementM);
    return {score.agreeing_m2, score.contradicted_m2, score.value()};
  }

  [[nodiscard]] std::optional<TwinEvidence> things(int source, int target,
                                                   const Rigid3& target_from_source) const {
    if (!meet(source, target, target_from_source)) return std::nullopt;
    return twin_of_given_pose(*cache_->get(node(source).key), *cache_->get(node(target).key),
                              world_pose(source, target, target_from_source),
                              twin_options(options_->nothing_repeats));
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
  const ScanHearing scans(nodes, options, cache);
  return {[scans](int source, int target, const Rigid3& pose) { return scans.surface(source, target, pose); },
          [scans](int source, int target, const Rigid3& pose) { return scans.things(source, target, pose); }};
}

}  // namespace limen
