// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/judge/given_pose.h"

#include <algorithm>
#include <cmath>

namespace limen {
namespace {

constexpr double kAsBuiltM = 0.05;  // by how much built matter may miss its drawing and count

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
                           const Rigid3& target_from_source, Method method) {
  const Rigid3 own = to_local(target_from_source, source.extracted.features.local_origin,
                              target.extracted.features.local_origin);
  const Rigid3 upright{target.upright_from_scan * own.rotation * source.upright_from_scan.transpose(),
                       target.upright_from_scan * own.translation};
  return score_pose(source.view(), target.view(), upright, fine_score(source.view(), target.view(), method));
}

}  // namespace limen
