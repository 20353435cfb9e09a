// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/hear_scans.h"

#include <memory>

#include "limen/project/retrieve/predict_overlap.h"
#include "limen/register/judge/given_pose.h"

namespace limen {

PoseHearing hearing_of_scans(const std::vector<ProjectNode>& nodes, const RegisterOptions& options,
                             ScanCache& cache) {
  return [&nodes, &options, &cache](int source, int target, const Rigid3& target_from_source) -> PoseHeard {
    const auto node = [&](int n) { return &nodes[static_cast<std::size_t>(n)]; };
    const auto askable = [&](int n) {
      return static_cast<std::size_t>(n) < nodes.size() && !node(n)->digest.mobile &&
             !node(n)->digest.model && !node(n)->digest.stations.empty();
    };
    if (!askable(source) || !askable(target)) return {};
    const ScanDigest& from = node(source)->digest;
    const ScanDigest& to = node(target)->digest;
    if (!box_of_planes(from, target_from_source).intersects(box_of_planes(to, {}))) return {};
    const std::shared_ptr<const PreparedScan> first = cache.get(node(source)->key);
    const std::shared_ptr<const PreparedScan> second = cache.get(node(target)->key);
    const Rigid3 world = to_world(target_from_source, from.local_origin, to.local_origin);
    const PoseScore score = score_given_pose(*first, *second, world, options.method);
    return {score.agreeing_m2, score.contradicted_m2};
  };
}

}  // namespace limen
