// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/judge/score_pose.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

#include "limen/base/progress.h"
#include "limen/match/openings/match_openings.h"
#include "limen/register/prepare/asked_samples.h"

namespace limen {
namespace {

constexpr double kClutterWeight = 0.5;  // clutter moves, and its cubes meet less sharply than planes

constexpr double kWallTilt = 0.5;  // |normal . up| of a wall is less

/// What the judge's scanner says to one sample of the other scan.
struct Answer {
  Sight sight;
  double area_m2 = 0.0;
  double gain_m2 = 0.0;  // agreeing surface, 1 - d^2 / t^2 of the area
  bool planar = false;

  [[nodiscard]] double contradicted_m2() const { return sight.kind == SightKind::free ? area_m2 : 0.0; }
  [[nodiscard]] double value() const { return gain_m2 - kContradictionWeight * contradicted_m2(); }
};

Answer ask(const SurfaceSample& sample, const ScanView& scan, const ScanView& judge,
           const Rigid3& judge_from_scan, const ScoreOptions& options) {
  Answer answer;
  answer.planar = sample.plane >= 0;
  SightQuery query;
  query.free_m = options.free_m;
  query.at = judge_from_scan * sample.mean;
  query.normal = answer.planar ? Vector3d(judge_from_scan.rotation * sample.normal) : Vector3d::Zero();
  query.oriented = answer.planar && scan.features->planes[static_cast<std::size_t>(sample.plane)].oriented;
  query.surface_m = answer.planar ? options.surface_m : 1.5 * options.surface_m;
  answer.sight = judge.space->look(query);
  answer.area_m2 = static_cast<double>(sample.area_m2) * (answer.planar ? 1.0 : kClutterWeight);
  if (answer.sight.kind == SightKind::surface) {
    const double off = answer.sight.distance_m / query.surface_m;
    answer.gain_m2 = answer.area_m2 * (1.0 - off * off);
  }
  return answer;
}

/// One plane counts for no more than this, m^2, however large: that two large planes meet is one coincidence,
/// not many.
constexpr double kPlaneLimit_m2 = 5.0;

double saturated(double area_m2) {
  return kPlaneLimit_m2 * (1.0 - std::exp(-area_m2 / kPlaneLimit_m2));
}

/// Whether a sample is of a wall that a model should have: upright, not seen through a window; of a mobile
/// scan, which sees much else, within the model's extent.
bool asks_wall(const SurfaceSample& sample, const ScanView& scan, const ScanView& model,
               const Rigid3& model_from_scan) {
  if (scan.features->planes[static_cast<std::size_t>(sample.plane)].interior) return false;
  if (std::abs(model_from_scan.rotation.row(2).dot(sample.normal)) > kWallTilt) return false;
  return !scan.mobile || model.reach.contains(model_from_scan * sample.mean);
}

/// Asks `judge` about every sample of `scan`.
PoseScore one_way(const ScanView& scan, const ScanView& judge, const Rigid3& judge_from_scan,
                  const ScoreOptions& options) {
  CancelScope::check();
  PoseScore score;
  if (judge.space == nullptr) return score;
  const std::vector<SurfaceSample>& samples = scan.features->samples;
  const AskedSamples asked = asked_samples(scan, judge, judge_from_scan, options.samples);
  const double factor = asked.factor;
  // Samples come plane by plane, clutter last.
  std::int32_t plane = -1;
  double of_plane = 0.0;
  double walls = 0.0;
  double explained = 0.0;
  for (const std::uint32_t i : asked.indices) {
    const Answer answer = ask(samples[i], scan, judge, judge_from_scan, options);
    const double gain = factor * answer.gain_m2;
    score.agreeing_m2 += gain;
    if (samples[i].plane != plane) {
      score.evidence_m2 += saturated(of_plane);
      of_plane = 0.0;
      plane = samples[i].plane;
    }
    if (answer.planar) {
      score.planar_m2 += gain;
      of_plane += gain;
      if (judge.model && asks_wall(samples[i], scan, judge, judge_from_scan)) {
        walls += answer.area_m2;
        if (answer.sight.kind == SightKind::surface) explained += answer.area_m2;
      }
    } else {
      score.evidence_m2 += gain;
    }
    score.contradicted_m2 += factor * answer.contradicted_m2();
    if (answer.sight.kind != SightKind::unseen) score.tested_m2 += factor * answer.area_m2;
  }
  score.evidence_m2 += saturated(of_plane);
  if (judge.model) score.explained_share = walls > 0 ? explained / walls : 1.0;
  return score;
}

/// The area of each source opening that meets one of the target, clipped as surface is.
std::vector<double> opening_gains(const ScanView& source, const ScanView& target, const Rigid3& pose,
                                  const ScoreOptions& options) {
  std::vector<double> gains(source.features->openings.size(), 0.0);
  if (!options.openings || gains.empty() || target.features->openings.empty()) return gains;
  OpeningMatchOptions matching;
  matching.gate_m = options.opening_m;
  for (const OpeningMatch& match : match_openings(*source.features, *target.features, pose, matching)) {
    const double off = std::hypot(match.shift_across_m, match.shift_up_m) / options.opening_m;
    gains[static_cast<std::size_t>(match.source)] = match.trust * match.area_m2 * (1.0 - off * off);
  }
  return gains;
}

void add_lead(double lead, PoseContrast& contrast) {
  (lead > 0 ? contrast.for_first_m2 : contrast.for_second_m2) += std::abs(lead);
}

/// What is asked under either pose.
AskedSamples asked_for_both(const ScanView& scan, const ScanView& judge, const Rigid3& first,
                            const Rigid3& second, const ScoreOptions& options) {
  AskedSamples asked = asked_samples(scan, judge, first, options.samples);
  if (!scan.model) return asked;
  const AskedSamples more = asked_samples(scan, judge, second, options.samples);
  std::vector<std::uint32_t> both;
  std::set_union(asked.indices.begin(), asked.indices.end(), more.indices.begin(), more.indices.end(),
                 std::back_inserter(both));
  asked.indices = std::move(both);
  return asked;
}

void add_contrast(const ScanView& scan, const ScanView& judge, const Rigid3& first, const Rigid3& second,
                  const ScoreOptions& options, PoseContrast& contrast) {
  CancelScope::check();
  if (judge.space == nullptr) return;
  const std::vector<SurfaceSample>& samples = scan.features->samples;
  const AskedSamples asked = asked_for_both(scan, judge, first, second, options);
  // Both ways are averaged, as in the score.
  const double share = 0.5 * asked.factor;
  std::vector<PoseContrast> planes(scan.features->planes.size());
  for (const std::uint32_t i : asked.indices) {
    const Answer in_first = ask(samples[i], scan, judge, first, options);
    const Answer in_second = ask(samples[i], scan, judge, second, options);
    const double agreeing = share * (in_first.gain_m2 - in_second.gain_m2);
    add_lead(agreeing, samples[i].plane >= 0 ? planes[static_cast<std::size_t>(samples[i].plane)] : contrast);
    // Matter where a ray passed is no coincidence: it counts in full.
    add_lead(share * kContradictionWeight * (in_second.contradicted_m2() - in_first.contradicted_m2()),
             contrast);
  }
  for (const PoseContrast& plane : planes) {
    contrast.for_first_m2 += saturated(plane.for_first_m2);
    contrast.for_second_m2 += saturated(plane.for_second_m2);
  }
}

}  // namespace

PoseScore score_pose(const ScanView& source, const ScanView& target, const Rigid3& target_from_source,
                     const ScoreOptions& options) {
  PoseScore forth;
  PoseScore back;
  if (options.ask_model || !source.model) forth = one_way(source, target, target_from_source, options);
  if (options.ask_model || !target.model)
    back = one_way(target, source, inverse(target_from_source), options);
  PoseScore both;
  both.agreeing_m2 = 0.5 * (forth.agreeing_m2 + back.agreeing_m2);
  both.planar_m2 = 0.5 * (forth.planar_m2 + back.planar_m2);
  both.contradicted_m2 = 0.5 * (forth.contradicted_m2 + back.contradicted_m2);
  both.tested_m2 = 0.5 * (forth.tested_m2 + back.tested_m2);
  both.explained_share = std::min(forth.explained_share, back.explained_share);
  for (const double gain : opening_gains(source, target, target_from_source, options))
    both.opening_m2 += gain;
  both.agreeing_m2 += both.opening_m2;
  both.evidence_m2 = 0.5 * (forth.evidence_m2 + back.evidence_m2) + both.opening_m2;
  return both;
}

PoseContrast contrast_poses(const ScanView& source, const ScanView& target, const Rigid3& first,
                            const Rigid3& second, const ScoreOptions& options) {
  PoseContrast contrast;
  add_contrast(source, target, first, second, options, contrast);
  add_contrast(target, source, inverse(first), inverse(second), options, contrast);
  const std::vector<double> in_first = opening_gains(source, target, first, options);
  const std::vector<double> in_second = opening_gains(source, target, second, options);
  for (std::size_t i = 0; i < in_first.size(); ++i) {
    add_lead(in_first[i] - in_second[i], contrast);
  }
  return contrast;
}

}  // namespace limen
