// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/score_pose.h"

namespace limen {
namespace {

constexpr double kClutterWeight = 0.5;  // clutter moves, and its cubes meet less sharply than planes

/// Asks `judge` about every sample of `scan`.
PoseScore one_way(const ScanView& scan, const ScanView& judge, const Rigid3& judge_from_scan,
                  const ScoreOptions& options) {
  PoseScore score;
  if (judge.space == nullptr) return score;
  SightQuery query;
  query.free_m = options.free_m;
  const std::vector<SurfaceSample>& samples = scan.features->samples;
  const std::size_t stride = options.samples == 0 ? 1 : 1 + samples.size() / options.samples;
  for (std::size_t i = 0; i < samples.size(); i += stride) {
    const SurfaceSample& sample = samples[i];
    const bool planar = sample.plane >= 0;
    query.at = judge_from_scan * sample.mean;
    query.normal = planar ? Vector3d(judge_from_scan.rotation * sample.normal) : Vector3d::Zero();
    query.oriented = planar && scan.features->planes[static_cast<std::size_t>(sample.plane)].oriented;
    query.surface_m = planar ? options.surface_m : 1.5 * options.surface_m;
    const Sight sight = judge.space->look(query);
    const double area =
        static_cast<double>(sample.area_m2) * static_cast<double>(stride) * (planar ? 1.0 : kClutterWeight);
    if (sight.kind == SightKind::surface) {
      const double off = sight.distance_m / query.surface_m;
      const double gain = area * (1.0 - off * off);
      score.agreeing_m2 += gain;
      if (planar) score.planar_m2 += gain;
    } else if (sight.kind == SightKind::free) {
      score.contradicted_m2 += area;
    }
    if (sight.kind != SightKind::unseen) score.tested_m2 += area;
  }
  return score;
}

}  // namespace

PoseScore score_pose(const ScanView& source, const ScanView& target, const Rigid3& target_from_source,
                     const ScoreOptions& options) {
  const PoseScore forth = one_way(source, target, target_from_source, options);
  const PoseScore back = one_way(target, source, inverse(target_from_source), options);
  PoseScore both;
  both.agreeing_m2 = 0.5 * (forth.agreeing_m2 + back.agreeing_m2);
  both.planar_m2 = 0.5 * (forth.planar_m2 + back.planar_m2);
  both.contradicted_m2 = 0.5 * (forth.contradicted_m2 + back.contradicted_m2);
  both.tested_m2 = 0.5 * (forth.tested_m2 + back.tested_m2);
  return both;
}

}  // namespace limen
