// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/judge/given_pose.h"

#include <algorithm>
#include <cmath>

#include "limen/register/judge/seen_clutter.h"

namespace limen {
namespace {

constexpr double kSigmas = 3.0;
constexpr double kAsBuiltM = 0.05;  // by how much what is built may miss its drawing and count

/// A pose between the scans' worlds, expressed between the frames that they were prepared in.
Rigid3 between_prepared(const PreparedScan& source, const PreparedScan& target,
                        const Rigid3& target_from_source) {
  const Rigid3 own = to_local(target_from_source, source.extracted.features.local_origin,
                              target.extracted.features.local_origin);
  return {target.upright_from_scan * own.rotation * source.upright_from_scan.transpose(),
          target.upright_from_scan * own.translation};
}

}  // namespace

double drift_m(const ScanView& source, const ScanView& target) {
  return std::hypot(source.features->drift_m, target.features->drift_m);
}

ScoreOptions fine_score(const ScanView& source, const ScanView& target, Method method) {
  ScoreOptions fine;
  fine.openings = method != Method::polygons;
  const double noise = std::max(source.features->noise_m, target.features->noise_m);
  fine.surface_m = std::clamp(std::max(4.0 * noise, 3.0 * drift_m(source, target)), 0.02, 0.05);
  // Nothing is built quite as it is drawn.
  if (source.model || target.model) fine.surface_m = kAsBuiltM;
  fine.free_m = fine.surface_m + 0.03;
  fine.opening_m = 0.1;
  return fine;
}

PoseScore score_given_pose(const PreparedScan& source, const PreparedScan& target,
                           const Rigid3& target_from_source, Method method, double uncertainty_m) {
  ScoreOptions score = fine_score(source.view(), target.view(), method);
  score.surface_m += uncertainty_m;
  score.free_m += kSigmas * uncertainty_m;
  return score_pose(source.view(), target.view(), between_prepared(source, target, target_from_source),
                    score);
}

LookAlikeEvidence look_alike_of_given_pose(const PreparedScan& source, const PreparedScan& target,
                                           const Rigid3& target_from_source,
                                           const LookAlikeOptions& options) {
  return weigh_look_alike(
      seen_clutter(source.view(), target.view(), between_prepared(source, target, target_from_source)),
      options);
}

}  // namespace limen
