// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/find_poses.h"

#include <algorithm>
#include <tuple>

#include "limen/base/parallel.h"
#include "limen/register/judge/evidence_table.h"
#include "limen/register/judge/given_pose.h"
#include "limen/register/judge/start_prior.h"
#include "limen/register/propose/propose.h"

namespace limen {
namespace {

double seen_m2(const Features& features) {
  double sum = 0.0;
  for (const SurfaceSample& sample : features.samples) sum += static_cast<double>(sample.area_m2);
  return sum;
}

/// What a side is ordered by before its single samples.
auto rough_order(const PreparedScan& side) {
  const Features& features = side.extracted.features;
  return std::tuple(side.model, side.mobile, seen_m2(features), features.samples.size());
}

bool comes_before(const SurfaceSample& a, const SurfaceSample& b) {
  return std::tuple(a.mean.x(), a.mean.y(), a.mean.z(), a.area_m2) <
         std::tuple(b.mean.x(), b.mean.y(), b.mean.z(), b.area_m2);
}

}  // namespace

bool is_work_order(const PreparedScan& source, const PreparedScan& target) {
  const auto first = rough_order(source);
  const auto second = rough_order(target);
  if (first != second) return first < second;
  const std::vector<SurfaceSample>& own = source.extracted.features.samples;
  const std::vector<SurfaceSample>& others = target.extracted.features.samples;
  return !std::lexicographical_compare(others.begin(), others.end(), own.begin(), own.end(), comes_before);
}

RefineOptions refine_options(const ScanView& source, const ScanView& target, const RegisterOptions& options) {
  constexpr double kGateSigmas = 4.0;  // of the sensor: surfaces nearer than that may be one
  RefineOptions refine = options.refine;
  refine.planes = refine.planes && options.method != Method::openings;
  refine.openings = refine.openings && options.method != Method::polygons;
  const double noise_m = std::max(source.features->noise_m, target.features->noise_m);
  refine.last_gate_m =
      std::min(refine.first_gate_m,
               std::max({refine.last_gate_m, kGateSigmas * noise_m, 2.5 * drift_m(source, target)}));
  if (options.wall_thickness_m > 0) refine.wall_thickness_m = options.wall_thickness_m;
  return refine;
}

WorkedPair worked_pair(const PreparedPair& pair) {
  if (is_work_order(pair.source, pair.target)) return {pair.source, pair.target, false};
  return {pair.target, pair.source, true};
}

namespace {

constexpr int kSettleSteps = 16;  // either way along a shift that the planes leave open
constexpr double kSettleStepM = 0.02;
constexpr std::size_t kSettleLooks = 5;  // of those steps that get a look at everything
constexpr double kCarefulGateM = 0.04;
constexpr double kWidestGateM = 1.0;               // about a start
constexpr std::size_t kPolished = 4;               // poses refined on every sample
constexpr std::size_t kMostPolished = 24;          // in a model those that agree as well as ...
constexpr double kAlikeShare = 0.9;                // ... the best, to this share
constexpr int kModelPoses = 128;                   // refined at least where a scan is sought in a model
constexpr std::size_t kModelRefineSamples = 1500;  // of each side, for all but the best of them

/// Least squares may leave a good pose along a shift that hardly anything holds: then smaller steps are
/// tried, and where they lead astray as well, the pose stays.
FoundPose refined_if_better(const ScanView& source, const ScanView& target, const Rigid3& start,
                            const RefineOptions& options, const PoseScorer& score_of) {
  const auto found = [&](const RefineOptions& refine) {
    FoundPose pose;
    pose.refined = refine_pose(source, target, start, refine);
    pose.score = score_of(pose.refined.target_from_source);
    return pose;
  };
  // Openings agree as well as what is known of their places allows.
  const auto value_of = [](const PoseScore& score) { return score.value() + score.unsure_opening_m2; };
  FoundPose pose = found(options);
  // Clearly worse: by a little the score may fall where a pose gets better.
  const double start_value = value_of(score_of(start));
  const double before = start_value - std::max(0.3, 0.05 * start_value);
  RefineOptions careful = options;
  if (value_of(pose.score) < before) {
    careful.first_gate_m = std::max(careful.last_gate_m, kCarefulGateM);
    careful.first_opening_gate_m = std::max(careful.last_opening_gate_m, 2.0 * kCarefulGateM);
    pose = found(careful);
  }
  if (value_of(pose.score) < before) {
    careful.rounds = 0;
    pose = found(careful);
  }
  return pose;
}

std::vector<FoundPose> refine_all(const std::vector<PoseCandidate>& candidates, const ScanView& source,
                                  const ScanView& target, const RegisterOptions& options) {
  ScoreOptions fine = fine_score(source, target, options.method);
  RefineOptions quick = refine_options(source, target, options);
  quick.samples = kSecondLook;
  // A model has ten times the surface that a scan saw of it; the poses that may become the answer are refined
  // and scored on all of it later.
  if (source.model || target.model) {
    quick.samples = kModelRefineSamples;
    fine.samples = kSecondLook;
  }
  const PoseScorer score_of(source, target, fine);
  std::vector<FoundPose> found(candidates.size());
  parallel_for(candidates.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      found[i] = refined_if_better(source, target, candidates[i].target_from_source, quick, score_of);
    }
  });
  return found;
}

void refine_and_score(FoundPose& pose, const ScanView& source, const ScanView& target,
                      const RegisterOptions& options, const PoseScorer& score_of) {
  pose = refined_if_better(source, target, pose.refined.target_from_source,
                           refine_options(source, target, options), score_of);
}

/// The steps along `direction` at which the surface agrees best, by a part of the samples: few are worth a
/// look at all of them.
std::vector<Rigid3> best_steps(const Rigid3& start, const Vector3d& direction, const PoseScorer& glance) {
  struct Step {
    Rigid3 pose;
    double value;
  };
  std::vector<Step> steps;
  for (int step = -kSettleSteps; step <= kSettleSteps; ++step) {
    Rigid3 moved = start;
    moved.translation += kSettleStepM * step * direction;
    steps.push_back({moved, glance(moved).value()});
  }
  std::stable_sort(steps.begin(), steps.end(),
                   [](const Step& a, const Step& b) { return a.value > b.value; });
  std::vector<Rigid3> best;
  for (std::size_t k = 0; k < kSettleLooks; ++k) best.push_back(steps[k].pose);
  return best;
}

/// Moves a pose along the shifts its planes leave open to where the rest of the surface agrees best; tells
/// whether it moved.
bool settle_open_shifts(FoundPose& pose, const ScanView& source, const ScanView& target,
                        const RegisterOptions& options, const PoseScorer& score_of) {
  const std::vector<UnobservedFreedom> open = unobserved_freedoms(pose.refined, options.verdict.min_held_m2);
  if (open.empty()) return false;
  ScoreOptions coarse = fine_score(source, target, options.method);
  coarse.samples = kSecondLook;
  const PoseScorer glance(source, target, coarse);
  bool moved_at_all = false;
  for (const UnobservedFreedom& freedom : open) {
    if (freedom.rotation) return moved_at_all;
    for (const Rigid3& moved : best_steps(pose.refined.target_from_source, freedom.direction, glance)) {
      const PoseScore score = score_of(moved);
      if (score.value() <= pose.score.value()) continue;
      pose.score = score;
      pose.refined.target_from_source = moved;
      moved_at_all = true;
    }
  }
  return moved_at_all;
}

/// The poses that may become the answer are refined once more, on everything.
void polish(std::vector<FoundPose>& poses, const ScanView& source, const ScanView& target,
            const RegisterOptions& options) {
  const std::vector<std::size_t> ranking = rank(poses, options.verdict);
  std::size_t count = std::min<std::size_t>(kPolished, ranking.size());
  // A model may have many rooms alike: none of them is to gain by being looked at more closely.
  if ((source.model || target.model) && !ranking.empty()) {
    const double enough = kAlikeShare * poses[ranking.front()].score.value();
    const std::size_t most = std::min<std::size_t>(kMostPolished, ranking.size());
    while (count < most && poses[ranking[count]].score.value() >= enough) ++count;
  }
  const PoseScorer score_of(source, target, fine_score(source, target, options.method));
  parallel_for(count, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      FoundPose& pose = poses[ranking[k]];
      refine_and_score(pose, source, target, options, score_of);
      // A pose that slid to its place meets surface that it had missed.
      if (settle_open_shifts(pose, source, target, options, score_of))
        refine_and_score(pose, source, target, options, score_of);
    }
  });
}

/// Asks a model about the walls that a scan saw, under every pose.
void balance_walls(std::vector<FoundPose>& poses, const ScanView& source, const ScanView& target) {
  if (!source.model && !target.model) return;
  const ModelWalls walls(source.model ? target : source, source.model ? source : target);
  parallel_for(poses.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Rigid3& pose = poses[i].refined.target_from_source;
      poses[i].walls = walls.under(source.model ? inverse(pose) : pose);
    }
  });
}

std::vector<FoundPose> distinct(const std::vector<FoundPose>& poses, const VerdictOptions& options) {
  std::vector<FoundPose> kept;
  for (const std::size_t i : rank(poses, options)) kept.push_back(poses[i]);
  return kept;
}

/// How an attempt proposes its poses.
enum class Proposal { held, sliding };

/// Steps of one attempt: poses from planes, coarse looks, refinement.
std::vector<FoundPose> attempt(const WorkedPair& pair, bool gravity_known, Proposal proposal,
                               const RegisterOptions& options, StageClock& clock) {
  const PreparedScan& source = pair.source;
  const PreparedScan& target = pair.target;
  clock.begin("hypotheses");
  ProposalOptions proposing{options.method, options.enumerate, options.wall_thickness_m};
  proposing.planes.gravity_known = gravity_known;
  proposing.thorough = gravity_known || !(source.upright && target.upright);
  proposing.model = source.model ? ModelSide::source : target.model ? ModelSide::target : ModelSide::none;
  const Features& from = source.extracted.features;
  const Features& to = target.extracted.features;
  std::vector<PoseCandidate> candidates = proposal == Proposal::held
                                              ? propose_poses(from, to, proposing)
                                              : propose_sliding_poses(from, to, proposing);
  clock.end();
  const std::optional<PreparedStart> start = prepared_start(pair, options);
  clock.begin("scoring");
  const bool model = pair.has_model();
  const int refined = model ? std::max(options.refined_poses, kModelPoses) : options.refined_poses;
  candidates = select_poses(candidates, source.view(), target.view(), static_cast<std::size_t>(refined),
                            options.method != Method::polygons);
  if (start && !model) {
    // Once as it is, and once from where surface leads that is as far off as the start may be.
    const Rigid3 given = start->given(start->prior.target_from_source);
    RefineOptions wide = refine_options(source.view(), target.view(), options);
    wide.samples = kSecondLook;
    wide.last_gate_m = wide.first_gate_m;
    wide.first_gate_m = std::max(wide.last_gate_m, std::min(start->prior.sigma_m, kWidestGateM));
    const Rigid3 led = refine_pose(source.view(), target.view(), given, wide).target_from_source;
    for (const Rigid3& pose : {given, led}) candidates.push_back({pose, 0.0});
  }
  clock.end();
  clock.begin("refinement");
  std::vector<FoundPose> found =
      distinct(refine_all(candidates, source.view(), target.view(), options), options.verdict);
  polish(found, source.view(), target.view(), options);
  balance_walls(found, source.view(), target.view());
  if (start) {
    for (FoundPose& pose : found) pose.log_prior = start->log_prior(pose.refined.target_from_source);
  }
  clock.end();
  return found;
}

/// Whether a pose is found that holds all six freedoms and that chance does not explain as well.
bool exceeds_chance(const std::vector<FoundPose>& poses, PairSort sort, const VerdictOptions& options) {
  const std::vector<double> against = nats_against_chance(poses, sort);
  for (std::size_t k = 0; k < poses.size(); ++k) {
    if (against[k] > 0.0 && unobserved_freedoms(poses[k].refined, options.min_held_m2).empty()) return true;
  }
  return false;
}

}  // namespace

PairSort sort_of(const WorkedPair& pair) {
  if (pair.has_model()) return PairSort::in_model;
  const Surroundings source = pair.source.surroundings;
  const Surroundings target = pair.target.surroundings;
  if (source == Surroundings::unknown || target == Surroundings::unknown) return PairSort::rooms;
  if (source == target) return source == Surroundings::outside ? PairSort::streets : PairSort::rooms;
  const PreparedScan& outside = source == Surroundings::outside ? pair.source : pair.target;
  return outside.mobile ? PairSort::past_wall : PairSort::through_wall;
}

double PreparedStart::log_prior(const Rigid3& pose) const {
  return log_prior_of_start(prior, given(pose), at, upright, evidence_table::kRooms.search_nats);
}

std::optional<PreparedStart> prepared_start(const WorkedPair& pair, const RegisterOptions& options) {
  if (!options.start) return std::nullopt;
  const PreparedScan& source = pair.turned ? pair.target : pair.source;
  const PreparedScan& target = pair.turned ? pair.source : pair.target;
  PreparedStart start{*options.start, source.reach.center(), source.upright && target.upright, pair.turned};
  const Rigid3 local = to_local(options.start->target_from_source, source.extracted.features.local_origin,
                                target.extracted.features.local_origin);
  const Matrix3d& up = target.upright_from_scan;
  start.prior.target_from_source = {up * local.rotation * source.upright_from_scan.transpose(),
                                    up * local.translation};
  return start;
}

std::vector<FoundPose> find_poses(const WorkedPair& pair, const RegisterOptions& options, StageClock& clock) {
  const PreparedScan& source = pair.source;
  const PreparedScan& target = pair.target;
  const bool level = source.upright && target.upright;
  const bool sure = source.surely_upright && target.surely_upright;
  const bool planes = options.method == Method::automatic || options.method == Method::polygons;
  std::vector<FoundPose> poses =
      distinct(attempt(pair, level, Proposal::held, options, clock), options.verdict);
  const PairSort sort = sort_of(pair);
  const auto search_on = [&](bool gravity_known, Proposal proposal) {
    if (exceeds_chance(poses, sort, options.verdict)) return;
    const std::vector<FoundPose> more = attempt(pair, gravity_known, proposal, options, clock);
    poses.insert(poses.end(), more.begin(), more.end());
    poses = distinct(poses, options.verdict);
  };
  if (level && !sure && options.gravity != Gravity::up) search_on(false, Proposal::held);
  // Through windows the openings fix the shift that planes leave open, if the method takes them.
  const bool held = pair.has_model() || (is_through_windows(sort) && options.method == Method::automatic);
  if (level && planes && !held) search_on(true, Proposal::sliding);
  return poses;
}

}  // namespace limen
