// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/register.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numeric>
#include <utility>

#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/geometry/polygon_clip.h"
#include "limen/register/judge/given_pose.h"
#include "limen/register/judge/hear_places.h"
#include "limen/register/judge/individual_matter.h"
#include "limen/register/judge/posterior.h"
#include "limen/register/judge/twin_odds.h"
#include "limen/register/prepare/model_rooms.h"
#include "limen/register/prepare/side_order.h"
#include "limen/register/prepare/stage_clock.h"
#include "limen/register/propose/propose.h"
#include "limen/register/propose/select_poses.h"
#include "limen/register/published/register_published.h"
#include "limen/register/refine/measure_thickness.h"

namespace limen {
namespace {

constexpr int kSettleSteps = 16;  // either way along a shift that the planes leave open
constexpr double kSettleStepM = 0.02;
constexpr std::size_t kSettleLooks = 5;  // of those steps that get a look at everything
constexpr double kCarefulGateM = 0.04;
constexpr std::size_t kPolished = 4;               // poses refined on every sample
constexpr int kModelPoses = 128;                   // refined at least where a scan is sought in a model
constexpr std::size_t kModelRefineSamples = 1500;  // of each side, for all but the best of them

/// The sides of a pair in the order in which they are worked on (side_order.h), and whether that is not the
/// order in which they were given.
struct WorkedPair {
  const PreparedScan& source;
  const PreparedScan& target;
  bool turned = false;
};

WorkedPair worked_pair(const PreparedPair& pair) {
  if (is_work_order(pair.source, pair.target)) return {pair.source, pair.target, false};
  return {pair.target, pair.source, true};
}

/// A pose between the upright frames, told between the scans' own.
JudgedPose in_own_frames(const JudgedPose& upright, const PreparedScan& source, const PreparedScan& target) {
  const Matrix3d back = target.upright_from_scan.transpose();
  JudgedPose own = upright;
  RefinedPose& pose = own.refined;
  pose.target_from_source = {back * pose.target_from_source.rotation * source.upright_from_scan,
                             back * pose.target_from_source.translation};
  pose.centre = back * pose.centre;
  Matrix6d both = Matrix6d::Zero();
  both.topLeftCorner<3, 3>() = back;
  both.bottomRightCorner<3, 3>() = back;
  pose.information = both * pose.information * both.transpose();
  pose.formal_information = both * pose.formal_information * both.transpose();
  pose.geometry_m2 = both * pose.geometry_m2 * both.transpose();
  return own;
}

/// The same between the frames of the pair as it was given.
JudgedPose as_given(const JudgedPose& upright, const WorkedPair& pair) {
  JudgedPose own = in_own_frames(upright, pair.source, pair.target);
  if (pair.turned) own.refined = inverted(own.refined);
  return own;
}

std::vector<MatchedOpenings> matched_openings(const RefinedPose& pose) {
  std::vector<MatchedOpenings> list;
  for (const OpeningMatch& match : pose.openings)
    list.push_back({match.source, match.target, match.shift_across_m, match.shift_up_m, match.by_outline});
  return list;
}

/// What the method refines on, and how near surfaces have to be.
RefineOptions refine_options(const ScanView& source, const ScanView& target, const RegisterOptions& options) {
  RefineOptions refine = options.refine;
  refine.planes = refine.planes && options.method != Method::openings;
  refine.openings = refine.openings && options.method != Method::polygons;
  refine.last_gate_m =
      std::min(refine.first_gate_m, std::max(refine.last_gate_m, 2.5 * drift_m(source, target)));
  if (options.wall_thickness_m > 0) refine.wall_thickness_m = options.wall_thickness_m;
  return refine;
}

/// Least squares may leave a good pose along a shift that hardly anything holds: then smaller steps are
/// tried, and where they lead astray as well, the pose stays.
JudgedPose refined_if_better(const ScanView& source, const ScanView& target, const Rigid3& start,
                             const RefineOptions& options, const PoseScorer& score_of) {
  const auto judged = [&](const RefineOptions& refine) {
    JudgedPose pose;
    pose.refined = refine_pose(source, target, start, refine);
    pose.score = score_of(pose.refined.target_from_source);
    return pose;
  };
  // Openings agree as well as what is known of their places allows.
  const auto value_of = [](const PoseScore& score) { return score.value() + score.unsure_opening_m2; };
  JudgedPose pose = judged(options);
  // Clearly worse: by a little the score may fall where a pose gets better.
  const double start_value = value_of(score_of(start));
  const double before = start_value - std::max(0.3, 0.05 * start_value);
  RefineOptions careful = options;
  if (value_of(pose.score) < before) {
    careful.first_gate_m = std::max(careful.last_gate_m, kCarefulGateM);
    careful.first_opening_gate_m = std::max(careful.last_opening_gate_m, 2.0 * kCarefulGateM);
    pose = judged(careful);
  }
  if (value_of(pose.score) < before) {
    careful.rounds = 0;
    pose = judged(careful);
  }
  return pose;
}

std::vector<JudgedPose> refine_all(const std::vector<PoseCandidate>& candidates, const ScanView& source,
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
  std::vector<JudgedPose> judged(candidates.size());
  parallel_for(candidates.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      judged[i] = refined_if_better(source, target, candidates[i].target_from_source, quick, score_of);
    }
  });
  return judged;
}

/// The room of the model that the first station stands in; `target_from_source`: the scans' own frames.
std::string room_of(const Rigid3& target_from_source, const PreparedPair& pair) {
  const PreparedScan& model = pair.source.model ? pair.source : pair.target;
  const PreparedScan& scan = pair.source.model ? pair.target : pair.source;
  if (!model.model || scan.stations.empty()) return {};
  const Vector3d station = scan.upright_from_scan.transpose() * scan.stations.front();
  return room_at(model.rooms,
                 (pair.source.model ? inverse(target_from_source) : target_from_source) * station);
}

/// Over what length a trajectory's error changes: its size over this is the turn it may cause. An error that
/// wanders along a wall of length E turns a fit to the whole of it by about 2.4 of its sizes over E.
constexpr double kDriftLengthM = 5.0;
constexpr double kTurnOfWandering = 2.4;

double longest_side(const PlanarPolygon& plane) {
  const Box2 box = box_of(plane.parts);
  return box.empty() ? 0.0 : (box.high - box.low).maxCoeff();
}

/// The longest wall that both scans saw, of each pair as far as the shorter goes.
double common_length_m(const RefinedPose& pose, const ScanView& source, const ScanView& target) {
  double longest = 0.0;
  for (const PlaneMatch& match : pose.matches)
    longest = std::max(
        longest, std::min(longest_side(source.features->planes[static_cast<std::size_t>(match.source)]),
                          longest_side(target.features->planes[static_cast<std::size_t>(match.target)])));
  return longest;
}

/// What the data hold, and what the trajectory may be off where this place was scanned: the matched surface
/// is seen within seconds, so that the error is one for all of it and does not average out.
Matrix6d covariance_with_drift(const RefinedPose& pose, const ScanView& source, const ScanView& target) {
  const double shift_m = drift_m(source, target);
  const double turn_rad =
      shift_m / std::max(kDriftLengthM, common_length_m(pose, source, target) / kTurnOfWandering);
  Matrix6d covariance = covariance_of(pose);
  covariance.diagonal().head<3>().array() += turn_rad * turn_rad;
  covariance.diagonal().tail<3>().array() += shift_m * shift_m;
  return covariance;
}

PoseSigma sigma_of(const RefinedPose& pose, const PreparedPair& pair) {
  PoseSigma sigma;
  sigma.centre = pose.centre + pair.target.extracted.features.local_origin;
  sigma.covariance = covariance_with_drift(pose, pair.source.view(), pair.target.view());
  sigma.formal_covariance = formal_covariance_of(pose);
  const Eigen::Matrix<double, 6, 1> deviation = sigma.covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  sigma.rotation_rad = deviation.head<3>();
  sigma.translation_m = deviation.tail<3>();
  return sigma;
}

Hypothesis to_hypothesis(const JudgedPose& pose, const PreparedPair& pair) {
  Hypothesis hypothesis;
  hypothesis.target_from_source =
      to_world(pose.refined.target_from_source, pair.source.extracted.features.local_origin,
               pair.target.extracted.features.local_origin);
  hypothesis.sigma = sigma_of(pose.refined, pair);
  hypothesis.score = pose.score.value();
  hypothesis.agreeing_m2 = pose.score.agreeing_m2;
  hypothesis.contradicted_m2 = pose.score.contradicted_m2;
  hypothesis.rms_m = pose.refined.rms_m;
  hypothesis.matched_planes = static_cast<int>(pose.refined.matches.size());
  hypothesis.matched_openings = static_cast<int>(pose.refined.openings.size());
  if (pair.source.model || pair.target.model) hypothesis.explained_share = pose.walls.share();
  hypothesis.room = room_of(pose.refined.target_from_source, pair);
  return hypothesis;
}

void refine_and_score(JudgedPose& pose, const ScanView& source, const ScanView& target,
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
bool settle_open_shifts(JudgedPose& pose, const ScanView& source, const ScanView& target,
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
void polish(std::vector<JudgedPose>& poses, const ScanView& source, const ScanView& target,
            const RegisterOptions& options) {
  const std::vector<std::size_t> ranking = rank(poses, options.verdict);
  const std::size_t count = std::min<std::size_t>(kPolished, ranking.size());
  const PoseScorer score_of(source, target, fine_score(source, target, options.method));
  parallel_for(count, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      JudgedPose& pose = poses[ranking[k]];
      refine_and_score(pose, source, target, options, score_of);
      // A pose that slid to its place meets surface that it had missed.
      if (settle_open_shifts(pose, source, target, options, score_of))
        refine_and_score(pose, source, target, options, score_of);
    }
  });
}

/// Asks a model about the walls that a scan saw, under every pose.
void balance_walls(std::vector<JudgedPose>& poses, const ScanView& source, const ScanView& target) {
  if (!source.model && !target.model) return;
  const ModelWalls walls(source.model ? target : source, source.model ? source : target);
  parallel_for(poses.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Rigid3& pose = poses[i].refined.target_from_source;
      poses[i].walls = walls.under(source.model ? inverse(pose) : pose);
    }
  });
}

/// A belief about the start between the prepared frames, and where it is asked: of the source that was given,
/// whichever is worked on as the source.
struct PreparedStart {
  StartPrior prior;
  Vector3d at = Vector3d::Zero();
  bool upright = false;
  bool turned = false;

  /// A worked pose as it is believed of, and the other way round.
  [[nodiscard]] Rigid3 given(const Rigid3& pose) const { return turned ? inverse(pose) : pose; }
  [[nodiscard]] double log_prior(const Rigid3& pose) const {
    return log_prior_of_start(prior, given(pose), at, upright, PosteriorOptions{}.search_nats);
  }
};

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

/// How an attempt proposes its poses.
enum class Proposal { held, sliding };

/// Steps of one attempt: poses from planes, coarse looks, refinement.
std::vector<JudgedPose> attempt(const WorkedPair& pair, bool gravity_known, Proposal proposal,
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
  const bool model = source.model || target.model;
  const int refined = model ? std::max(options.refined_poses, kModelPoses) : options.refined_poses;
  candidates = select_poses(candidates, source.view(), target.view(), static_cast<std::size_t>(refined),
                            options.method != Method::polygons);
  if (start && !model) candidates.push_back({start->given(start->prior.target_from_source), 0.0, 0});
  clock.end();
  clock.begin("refinement");
  std::vector<JudgedPose> judged = refine_all(candidates, source.view(), target.view(), options);
  polish(judged, source.view(), target.view(), options);
  balance_walls(judged, source.view(), target.view());
  if (start) {
    for (JudgedPose& pose : judged)
      pose.prior_m2 = start->log_prior(pose.refined.target_from_source) / PosteriorOptions{}.nats_per_m2;
  }
  clock.end();
  return judged;
}

/// Places in the ranking of the poses that are told besides the best: all that cannot be told from it, and
/// then some.
std::vector<std::size_t> told_alternatives(const Verdict& verdict, const RegisterOptions& options) {
  std::vector<std::size_t> told;
  for (std::size_t k = 1; k < verdict.ranking.size(); ++k) {
    const std::size_t pose = verdict.ranking[k];
    const bool rival = std::find(verdict.rivals.begin(), verdict.rivals.end(), pose) != verdict.rivals.end();
    if (rival || told.size() < static_cast<std::size_t>(options.alternatives)) told.push_back(pose);
  }
  return told;
}

/// What is known of the best pose beside how much surface agrees.
struct ThingsSaid {
  double twin = 0.0;       ///< probability of one
  std::string twin_words;  ///< what a user should know of it
  /// Of the pose's value what things say, and what they say asked one by one; both 0 where they were not.
  double things_m2 = 0.0;
  double things_nats = 0.0;
};

/// Probabilities of the best pose, of `others` and of `twins`, and of what else may be.
Posterior posterior_of(const std::vector<JudgedPose>& poses, const Verdict& verdict,
                       const std::vector<std::size_t>& others, const std::vector<TwinPlace>& twins,
                       const ContrastFunction& contrast, const ThingsSaid& said, bool model,
                       bool through_wall) {
  const std::size_t best = verdict.ranking.front();
  PosteriorEvidence evidence;
  evidence.best_value_m2 = poses[best].score.value();
  evidence.twin = said.twin;
  evidence.things_m2 = said.things_m2;
  evidence.things_nats = said.things_nats;
  evidence.through_wall = through_wall;
  const auto add_prior = [&](std::size_t pose) {
    evidence.log_priors.push_back(poses[pose].prior_m2 * PosteriorOptions{}.nats_per_m2);
  };
  add_prior(best);
  if (model) evidence.log_odds_of_model = verdict.log_odds_of_model;
  std::vector<PoseContrast> apart(others.size());
  parallel_for(others.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) apart[k] = contrast(best, others[k]);
  });
  for (std::size_t k = 0; k < others.size(); ++k) {
    evidence.leads_m2.push_back(apart[k].for_first_m2 - apart[k].for_second_m2);
    evidence.values_m2.push_back(poses[others[k]].score.value());
    add_prior(others[k]);
  }
  for (const TwinPlace& twin : twins) evidence.odds_of_twins.push_back(twin.said.odds());
  return posterior(evidence);
}

/// Puts the alternatives in the order of their probabilities, which stand behind that of the best pose.
void sort_by_probability(std::vector<std::size_t>& others, std::vector<double>& probabilities) {
  std::vector<std::size_t> order(others.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return probabilities[a + 1] > probabilities[b + 1]; });
  const std::vector<std::size_t> poses = others;
  const std::vector<double> before = probabilities;
  for (std::size_t k = 0; k < order.size(); ++k) {
    others[k] = poses[order[k]];
    probabilities[k + 1] = before[order[k] + 1];
  }
}

/// The walls between the scans, as the pair was given.
std::vector<MeasuredThickness> thickness_under(const RefinedPose& upright, const WorkedPair& pair) {
  std::vector<MeasuredThickness> walls =
      measure_thickness(upright, pair.source.extracted.features, pair.target.extracted.features);
  for (MeasuredThickness& wall : walls) {
    if (pair.turned) std::swap(wall.source_plane, wall.target_plane);
  }
  return walls;
}

/// The result in the frames of the scans as they were given (`pair`).
void tell(Verdict verdict, const std::vector<JudgedPose>& poses, const std::vector<TwinPlace>& twins,
          const ContrastFunction& contrast, const ThingsSaid& said, const PreparedPair& pair,
          const WorkedPair& worked, const RegisterOptions& options, RegistrationResult& result) {
  result.outcome = verdict.outcome;
  result.reason = verdict.reason;
  result.judged_poses = poses.size();
  if (verdict.ranking.empty()) return;
  const RefinedPose& upright = poses[verdict.ranking.front()].refined;
  const JudgedPose best = as_given(poses[verdict.ranking.front()], worked);
  std::vector<std::size_t> others = told_alternatives(verdict, options);
  const bool model = pair.source.model || pair.target.model;
  Posterior all = posterior_of(poses, verdict, others, twins, contrast, said, model,
                               !model && pair.source.mobile != pair.target.mobile);
  sort_by_probability(others, all.poses);
  for (std::size_t k = 0; k < others.size(); ++k) {
    if (is_slid(upright, poses[others[k]].refined, options.verdict)) all.slid += all.poses[k + 1];
  }
  for (const TwinPlace& twin : twins) others.push_back(twin.pose);
  const OpenFreedoms open =
      open_freedoms(best.refined, covariance_with_drift(best.refined, pair.source.view(), pair.target.view()),
                    options.verdict);
  verdict = decided(std::move(verdict), all, open, said.twin_words, options.verdict);
  result.outcome = verdict.outcome;
  result.reason = verdict.reason;
  result.unobserved = verdict.unobserved;
  result.best = to_hypothesis(best, pair);
  result.best.probability = all.best();
  result.others = all.others;
  result.sigma = result.best.sigma;
  result.matches = best.refined.matches;
  result.openings = matched_openings(best.refined);
  result.thickness = thickness_under(upright, worked);
  result.rivals = verdict.rivals.size();
  for (std::size_t k = 0; k < others.size(); ++k) {
    result.alternatives.push_back(to_hypothesis(as_given(poses[others[k]], worked), pair));
    result.alternatives.back().probability = all.poses[k + 1];
    result.alternatives.back().tie =
        std::find(verdict.rivals.begin(), verdict.rivals.end(), others[k]) != verdict.rivals.end();
  }
  if (!twins.empty()) {
    const double right =
        std::accumulate(all.poses.end() - static_cast<std::ptrdiff_t>(twins.size()), all.poses.end(), 0.0);
    result.built_alike = PlaceBuiltAlike{to_hypothesis(as_given(poses[twins.front().pose], worked), pair),
                                         twins.front().said, right};
  }
}

constexpr double kTwinRather = 0.5;  // probability of a twin above which things tell two rooms

/// Whether two rooms built alike could be taken for one: of a model, or of the house seen from the street,
/// the other places are searched as well, and are rivals.
bool may_be_twin(const PreparedScan& from, const PreparedScan& to) {
  return !from.model && !to.model && !from.mobile && !to.mobile;
}

/// Whether more agrees under the best pose than any wrong one reaches by chance.
bool is_beyond_chance(const JudgedPose& best) {
  const PosteriorOptions odds;
  return odds.nats_per_m2 * best.score.value() > odds.search_nats;
}

/// Whether what things say of a twin is to be known: of a pose that is refused as well where nothing else
/// would make it improbable.
bool is_to_ask_for_twins(const std::vector<JudgedPose>& poses, const Verdict& verdict) {
  if (verdict.ranking.empty()) return false;
  return verdict.outcome != Outcome::no_match || is_beyond_chance(poses[verdict.ranking.front()]);
}

/// Whether poses that no third plane fixes are worth a search: none was found, or the best leaves a shift
/// open and reaches no more than the best of all wrong ones does.
bool is_to_slide(const std::vector<JudgedPose>& poses, const Verdict& verdict) {
  if (verdict.outcome == Outcome::no_match || verdict.ranking.empty()) return true;
  return verdict.outcome == Outcome::under_constrained && !is_beyond_chance(poses[verdict.ranking.front()]);
}

}  // namespace

ExtractOptions features_for_registration() {
  ExtractOptions options;
  options.grow.min_inliers = 60;
  return options;
}

PrepareOptions prepare_options(const RegisterOptions& options) {
  if (options.as_published)
    return published_preparation(*options.as_published, options.gravity, options.seed);
  PrepareOptions preparing;
  preparing.extract = options.extract;
  preparing.extract.detect.seed = options.seed;
  preparing.gravity = options.gravity;
  preparing.segments = options.method == Method::segments;
  return preparing;
}

void RegisterOptions::check() const {
  extract.check();
  enumerate.check();
  refine.check();
  verdict.check();
  if (!(wall_thickness_m >= 0 && wall_thickness_m < 5))
    throw_bad_option("wall_thickness_m", wall_thickness_m, "within [0, 5)");
  if (refined_poses < 1) throw_bad_option("refined_poses", refined_poses, "1 or more");
  if (alternatives < 0) throw_bad_option("alternatives", alternatives, "0 or more");
}

TwinOptions RegisterOptions::twins() const {
  return nothing_repeats ? where_nothing_repeats(verdict.twin) : verdict.twin;
}

RegistrationResult register_prepared(const PreparedPair& pair, const RegisterOptions& options,
                                     Monitor& monitor) {
  options.check();
  if (options.start) options.start->check();
  if (options.as_published)
    return register_as_published(pair, {*options.as_published, options.wall_thickness_m, options.seed},
                                 monitor);
  const WorkedPair worked = worked_pair(pair);
  const PreparedScan& from = worked.source;
  const PreparedScan& to = worked.target;
  RegistrationResult result;
  StageClock clock(result.stages, monitor);
  const bool level = from.upright && to.upright;
  std::vector<JudgedPose> poses = attempt(worked, level, Proposal::held, options, clock);
  const ContrastFunction contrast = [&](std::size_t first, std::size_t second) {
    return contrast_poses(from.view(), to.view(), poses[first].refined.target_from_source,
                          poses[second].refined.target_from_source,
                          fine_score(from.view(), to.view(), options.method));
  };
  VerdictOptions judging = options.verdict;
  judging.twin = options.twins();
  const bool model = from.model || to.model;
  judging.in_model = model;
  judging.through_wall = !model && from.mobile != to.mobile;
  Verdict verdict = judge(poses, contrast, judging);
  std::optional<IndividualMatter> individual;  // under the best pose, once it was asked for
  std::map<const RefinedPose*, IndividualMatter> asked;
  std::optional<MatterAsker> ask_matter;
  const MatterFunction matter_under = [&](const RefinedPose& pose) {
    const auto known = asked.find(&pose);
    if (known != asked.end()) return known->second;
    if (!ask_matter) ask_matter.emplace(from.view(), to.view());
    return asked.emplace(&pose, (*ask_matter)(pose.target_from_source)).first->second;
  };
  // Of a room in use things stand where the other scan saw free space: no contradiction, if enough of the
  // rest is where it was to tell the room from its twins.
  if (verdict.outcome == Outcome::no_match && may_be_twin(from, to) && !verdict.ranking.empty()) {
    VerdictOptions bearing = judging;
    bearing.max_contradiction = judging.max_contradiction_in_use;
    Verdict in_use = judge(poses, contrast, bearing);
    if (in_use.outcome != Outcome::no_match) {
      IndividualMatter matter = matter_under(poses[in_use.ranking.front()].refined);
      if (probability_of_twin(matter, judging.twin) < kTwinRather) {
        verdict = std::move(in_use);
        individual = std::move(matter);
      }
    }
  }
  const auto try_again = [&](bool gravity_known, Proposal proposal) {
    const std::vector<JudgedPose> more = attempt(worked, gravity_known, proposal, options, clock);
    asked.clear();  // the poses move
    poses.insert(poses.end(), more.begin(), more.end());
    verdict = judge(poses, contrast, judging);
  };
  // A place built alike shows more surface than a door leaves of the right one.
  std::vector<TwinPlace> twins;
  if (may_be_twin(from, to) && !options.start && !verdict.ranking.empty()) {
    std::optional<HeardPlaces> heard = hear_past_twins(poses, verdict, contrast, matter_under, judging);
    if (heard) {
      verdict = std::move(heard->verdict);
      twins = std::move(heard->twins);
      individual.reset();
    }
  }
  const bool sure = from.surely_upright && to.surely_upright;
  if (verdict.outcome == Outcome::no_match && level && !sure && options.gravity != Gravity::up)
    try_again(false, Proposal::held);
  const bool planes = options.method == Method::automatic || options.method == Method::polygons;
  if (is_to_slide(poses, verdict) && level && planes && !model) try_again(true, Proposal::sliding);
  if (!verdict.ranking.empty()) {
    const std::size_t led = verdict.ranking.front();
    verdict = led_by_likeliest(std::move(verdict), poses, contrast, judging);
    if (verdict.ranking.front() != led) individual.reset();
  }
  const std::optional<PreparedStart> start = prepared_start(worked, options);
  ThingsSaid said;
  if (is_to_ask_for_twins(poses, verdict) && may_be_twin(from, to)) {
    const bool refused = verdict.outcome == Outcome::no_match;
    const RefinedPose& refined = poses[verdict.ranking.front()].refined;
    const Rigid3& best = refined.target_from_source;
    if (!individual) individual = matter_under(refined);
    const TwinEvidence twin = weigh_twin(*individual, judging.twin);
    said.twin = twin.probability();
    if (start)
      said.twin =
          twin_beside_start(said.twin, start->prior, start->given(best), start->at, start->log_prior(best));
    said.twin_words = twin_words(*individual, said.twin);
    // Things that meet by chance agree as those of a room furnished otherwise do.
    said.things_nats = twin.otherwise_nats;
    said.things_m2 =
        value_of_things_m2(from.view(), to.view(), best, fine_score(from.view(), to.view(), options.method),
                           individual->source_built, individual->target_built);
    if (!refused) result.twin = twin;
  }
  if (start && !verdict.ranking.empty()) {
    const StartMiss miss = miss_of_start(
        start->prior, start->given(poses[verdict.ranking.front()].refined.target_from_source), start->at);
    result.start = StartAgreement{miss.shift_m, miss.turn_rad, miss.sigmas};
  }
  tell(verdict, poses, twins, contrast, said, pair, worked, options, result);
  return result;
}

}  // namespace limen
