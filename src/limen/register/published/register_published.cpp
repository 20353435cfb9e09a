// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/published/register_published.h"

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/register/judge/model_walls.h"
#include "limen/register/judge/score_pose.h"
#include "limen/register/prepare/stage_clock.h"
#include "limen/register/published/published_pose.h"
#include "limen/register/refine/refine_pose.h"

namespace limen {
namespace {

/// The start x_target = x_source (world), between the prepared frames.
Rigid3 start_between(const PreparedScan& source, const PreparedScan& target) {
  const Vector3d shift = source.extracted.features.local_origin - target.extracted.features.local_origin;
  return {target.upright_from_scan * source.upright_from_scan.transpose(), target.upright_from_scan * shift};
}

PublishedAnswer answer_of(PublishedMethod method, const PublishedInput& input) {
  switch (method) {
    case PublishedMethod::threshold_2021:
      return register_threshold_2021(input);
    case PublishedMethod::cluster_2021:
      return register_cluster_2021(input);
    case PublishedMethod::openings_2022:
      return register_openings_2022(input);
    case PublishedMethod::hybrid_2023:
      return register_hybrid_2023(input);
    case PublishedMethod::segments_2023:
      return register_segments_2023(input);
  }
  return {};
}

PublishedScore score_of(PublishedMethod method, const PublishedPose& pose) {
  PublishedScore score;
  score.method = to_string(method);
  score.value = pose.criterion;
  score.unit = method == PublishedMethod::openings_2022 ? "m3" : "m2";
  score.lower_is_better =
      method != PublishedMethod::threshold_2021 && method != PublishedMethod::cluster_2021;
  score.hypotheses = pose.hypotheses;
  return score;
}

UnobservedFreedom freedom_of(const Vector3d& direction, bool rotation) {
  UnobservedFreedom freedom;
  freedom.rotation = rotation;
  freedom.direction = direction;
  freedom.name = fmt::format("{} ({:.2f}, {:.2f}, {:.2f})", rotation ? "turn about" : "shift along",
                             direction.x() + 0.0, direction.y() + 0.0, direction.z() + 0.0);
  return freedom;
}

std::vector<UnobservedFreedom> open_freedoms(const PublishedPose& pose, const Matrix3d& back) {
  std::vector<UnobservedFreedom> list;
  for (const Vector3d& direction : pose.not_held) list.push_back(freedom_of(back * direction, false));
  if (pose.free_turn) list.push_back(freedom_of(back * *pose.free_turn, true));
  return list;
}

/// What limen's own measure says of the pose, which stays as it is.
Hypothesis measured(const PublishedPose& pose, const PreparedPair& pair, RegistrationResult& result) {
  const ScanView source = pair.source.view();
  const ScanView target = pair.target.view();
  RefineOptions unmoved;
  unmoved.rounds = 0;
  const RefinedPose at = refine_pose(source, target, pose.target_from_source, unmoved);
  const PoseScore score = score_pose(source, target, pose.target_from_source, {});
  const Matrix3d back = pair.target.upright_from_scan.transpose();
  const Rigid3 own = {back * pose.target_from_source.rotation * pair.source.upright_from_scan,
                      back * pose.target_from_source.translation};
  Hypothesis best;
  best.target_from_source =
      to_world(own, pair.source.extracted.features.local_origin, pair.target.extracted.features.local_origin);
  best.score = score.value();
  best.agreeing_m2 = score.agreeing_m2;
  best.contradicted_m2 = score.contradicted_m2;
  best.rms_m = at.rms_m;
  best.matched_planes = static_cast<int>(at.matches.size());
  best.matched_openings = static_cast<int>(at.openings.size());
  if (source.model || target.model) {
    const ModelWalls walls(source.model ? target : source, source.model ? source : target);
    best.explained_share =
        walls.under(source.model ? inverse(pose.target_from_source) : pose.target_from_source).share();
  }
  result.matches = at.matches;
  return best;
}

std::string reason_of(const RegistrationResult& result) {
  return fmt::format(
      "the published method {} gives one pose and considers no other; by limen's own measure {:.1f} m2 of "
      "surface agree and {:.1f} m2 contradict",
      result.published->method, result.best.agreeing_m2, result.best.contradicted_m2);
}

}  // namespace

PrepareOptions published_preparation(PublishedMethod method, Gravity gravity, std::uint64_t seed) {
  PrepareOptions options;
  options.extract.detect = {PlaneDetector::published, ThresholdRule::published, seed};
  options.gravity = gravity;
  options.segments = method == PublishedMethod::segments_2023;
  options.sampled_model = options.segments;
  options.keep = kKeepAll;  // as printed
  return options;
}

void check_sides(PublishedMethod method, bool with_model) {
  if (!with_model || method == PublishedMethod::segments_2023) return;
  throw Error(fmt::format("the published method {} registers two scans, not a model", to_string(method)),
              "--as-published", "use 2023-segments, or leave the option out");
}

RegistrationResult register_as_published(const PreparedPair& pair, const PublishedOptions& options,
                                         Monitor& monitor) {
  const PreparedScan& from = pair.source;
  const PreparedScan& to = pair.target;
  check_sides(options.method, from.model || to.model);
  RegistrationResult result;
  StageClock clock(result.stages, monitor);
  clock.begin("published method");
  PublishedInput input{from.extracted.features, to.extracted.features};
  input.start = start_between(from, to);
  input.source_outside = from.mobile;
  input.target_outside = to.mobile;
  input.upright = from.upright && to.upright;
  input.wall_thickness_m = options.wall_thickness_m;
  input.seed = options.seed;
  const PublishedAnswer answer = answer_of(options.method, input);
  clock.end();
  if (!answer.pose) {
    result.reason =
        fmt::format("the published method {} finds no pose: {}", to_string(options.method), answer.why_none);
    return result;
  }
  result.judged_poses = 1;
  result.published = score_of(options.method, *answer.pose);
  result.best = measured(*answer.pose, pair, result);
  result.unobserved = open_freedoms(*answer.pose, to.upright_from_scan.transpose());
  result.outcome = result.unobserved.empty() ? Outcome::ambiguous : Outcome::under_constrained;
  result.reason = reason_of(result);
  return result;
}

}  // namespace limen
