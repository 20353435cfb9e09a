// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/register.h"

#include <algorithm>
#include <map>
#include <utility>

#include "limen/base/error.h"
#include "limen/geometry/polygon_clip.h"
#include "limen/register/find_poses.h"
#include "limen/register/judge/given_pose.h"
#include "limen/register/judge/look_alike_odds.h"
#include "limen/register/judge/posterior.h"
#include "limen/register/judge/seen_clutter.h"
#include "limen/register/judge/start_prior.h"
#include "limen/register/prepare/prepare_model.h"
#include "limen/register/published/register_published.h"
#include "limen/register/refine/measure_thickness.h"

namespace limen {
namespace {

/// A pose between the upright frames, given between the scans' own.
FoundPose in_own_frames(const FoundPose& upright, const PreparedScan& source, const PreparedScan& target) {
  const Matrix3d back = target.upright_from_scan.transpose();
  FoundPose own = upright;
  RefinedPose& pose = own.refined;
  pose.target_from_source = {back * pose.target_from_source.rotation * source.upright_from_scan,
                             back * pose.target_from_source.translation};
  pose.centre = back * pose.centre;
  Matrix6d both = Matrix6d::Zero();
  both.topLeftCorner<3, 3>() = back;
  both.bottomRightCorner<3, 3>() = back;
  for (Matrix6d* held : about_centre(pose)) *held = both * *held * both.transpose();
  return own;
}

/// The same between the frames of the pair as it was given.
FoundPose as_given(const FoundPose& upright, const WorkedPair& pair) {
  FoundPose own = in_own_frames(upright, pair.source, pair.target);
  if (pair.turned) own.refined = inverted(own.refined);
  return own;
}

std::vector<MatchedOpenings> matched_openings(const RefinedPose& pose) {
  std::vector<MatchedOpenings> list;
  for (const OpeningMatch& match : pose.openings)
    list.push_back({match.source, match.target, match.shift_across_m, match.shift_up_m, match.by_outline});
  return list;
}

/// The room of the model that the first station is in; `target_from_source`: the scans' own frames.
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
  sigma.covariance = covariance_with_drift(pose, pair.source.view(), pair.target.view()) + pose.spread;
  sigma.formal_covariance = formal_covariance_of(pose);
  const Eigen::Matrix<double, 6, 1> deviation = sigma.covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  sigma.rotation_rad = deviation.head<3>();
  sigma.translation_m = deviation.tail<3>();
  return sigma;
}

Hypothesis to_hypothesis(const FoundPose& pose, const PreparedPair& pair) {
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

/// The walls between the scans, as the pair was given.
std::vector<MeasuredThickness> thickness_under(const RefinedPose& upright, const WorkedPair& pair) {
  std::vector<MeasuredThickness> walls =
      measure_thickness(upright, pair.source.extracted.features, pair.target.extracted.features);
  for (MeasuredThickness& wall : walls) {
    if (pair.turned) std::swap(wall.source_plane, wall.target_plane);
  }
  return walls;
}

/// What the two scans say of the poses, each question once.
class AskedPair {
 public:
  AskedPair(const WorkedPair& pair, const std::vector<FoundPose>& poses, const RegisterOptions& options)
      : pair_(pair),
        poses_(poses),
        options_(options),
        score_(fine_score(pair.source.view(), pair.target.view(), options.method)),
        start_(prepared_start(pair, options)) {}

  [[nodiscard]] PairQuestions questions() {
    PairQuestions questions;
    questions.contrast = [this](std::size_t first, std::size_t second) { return contrast(first, second); };
    if (sort_of(pair_) == PairSort::rooms)
      questions.look_alike = [this](std::size_t pose) { return beside_start(pose, weigh_things(pose)); };
    else if (is_through_windows(sort_of(pair_)))
      questions.look_alike = [this](std::size_t pose) { return weigh_surfaces(pose); };
    questions.repeats = repeats();
    return questions;
  }
  /// What is known of look-alike places, without a belief about the start: of rooms where a pose was asked
  /// about, through windows for a project's sake.
  [[nodiscard]] std::optional<LookAlikeEvidence> look_alike(std::size_t pose) const {
    if (is_through_windows(sort_of(pair_)))
      return look_alike_through_windows(poses_[pose].score, sort_of(pair_), repeats());
    const auto found = things_.find(pose);
    return found == things_.end() ? std::nullopt : std::optional(found->second.evidence);
  }
  /// Why a look-alike place cannot be excluded, of so large a probability.
  [[nodiscard]] std::string look_alike_words(std::size_t pose, double probability) const {
    const auto found = things_.find(pose);
    return found == things_.end() ? "" : limen::look_alike_words(found->second.seen, probability);
  }
  [[nodiscard]] std::optional<StartAgreement> agreement_with_start(std::size_t pose) const {
    if (!start_) return std::nullopt;
    return miss_of_start(start_->prior, start_->given(pose_of(pose)), start_->at);
  }

 private:
  [[nodiscard]] const Rigid3& pose_of(std::size_t k) const { return poses_[k].refined.target_from_source; }
  [[nodiscard]] PoseContrast contrast(std::size_t first, std::size_t second) {
    if (contrasted_ != first) {
      contrasts_.emplace(pair_.source.view(), pair_.target.view(), pose_of(first), score_);
      contrasted_ = first;
    }
    return (*contrasts_)(pose_of(second));
  }
  struct Things {
    SeenClutter seen;
    LookAlikeEvidence evidence;
  };

  [[nodiscard]] double repeats() const {
    return look_alike_options(options_.nothing_repeats).alike / evidence_table::kAlike;
  }
  [[nodiscard]] const ClutterComparer& asker() {
    if (!asker_) asker_.emplace(pair_.source.view(), pair_.target.view());
    return *asker_;
  }
  /// Look-alike rooms behind windows are among the poses.
  [[nodiscard]] LookAlikeEvidence weigh_surfaces(std::size_t pose) {
    LookAlikeEvidence evidence;
    evidence.otherwise = 0.0;
    evidence.built = asker().built(pose_of(pose));
    return evidence;
  }
  [[nodiscard]] LookAlikeEvidence weigh_things(std::size_t pose) {
    SeenClutter seen = asker()(pose_of(pose));
    LookAlikeEvidence evidence = weigh_look_alike(seen, look_alike_options(options_.nothing_repeats));
    things_.insert_or_assign(pose, Things{std::move(seen), evidence});
    return evidence;
  }
  [[nodiscard]] LookAlikeEvidence beside_start(std::size_t pose, LookAlikeEvidence evidence) const {
    if (!start_) return evidence;
    const double believed = odds_of_look_alike_beside_start(start_->prior, start_->given(pose_of(pose)),
                                                            start_->at, poses_[pose].log_prior);
    evidence.otherwise *= believed;
    evidence.alike *= believed;
    return evidence;
  }

  const WorkedPair& pair_;
  const std::vector<FoundPose>& poses_;
  const RegisterOptions& options_;
  ScoreOptions score_;
  std::optional<PreparedStart> start_;
  std::optional<std::size_t> contrasted_;  ///< the pose that contrasts are with
  std::optional<PoseContrasts> contrasts_;
  std::optional<ClutterComparer> asker_;
  std::map<std::size_t, Things> things_;
};

/// How many of the likeliest poses are listed besides the best: as many as are asked for, all that cannot be
/// excluded, and all of those that together are as probable as an answer has to be.
std::size_t count_of_alternatives(const Posterior& posterior, const RegisterOptions& options) {
  std::size_t count =
      std::max(static_cast<std::size_t>(options.alternatives), posterior.rivals(options.verdict.risk));
  double covered = posterior.best();
  std::size_t needed = 0;
  while (needed + 1 < posterior.order.size() && covered < 1.0 - options.verdict.probable_risk)
    covered += posterior.probabilities[++needed];
  const bool can_cover = covered >= 1.0 - options.verdict.probable_risk;
  if (can_cover) count = std::max(count, needed);
  return std::min(count, posterior.order.size() - 1);
}

/// The result in the frames of the scans as they were given (`pair`).
void write_result(const std::vector<FoundPose>& poses, Posterior posterior, const AskedPair& asked,
                  const PreparedPair& pair, const WorkedPair& worked, const RegisterOptions& options,
                  RegistrationResult& result) {
  const std::size_t leader = posterior.order.front();
  FoundPose upright = poses[leader];
  const ScanView source = worked.source.view();
  const ScanView target = worked.target.view();
  if (!worked.has_model())
    find_moved(source, target, refine_options(source, target, options), upright.refined);
  const FoundPose best = as_given(upright, worked);
  for (std::size_t k = 1; k < posterior.order.size(); ++k) {
    if (is_slid(upright.refined, poses[posterior.order[k]].refined, options.verdict))
      posterior.slid += posterior.probabilities[k];
  }
  const OpenFreedoms open =
      open_freedoms(best.refined, covariance_with_drift(best.refined, pair.source.view(), pair.target.view()),
                    options.verdict);
  const std::string look_alike = asked.look_alike_words(leader, posterior.others.look_alike);
  result.outcome = outcome_of(posterior, open.list, options.verdict);
  result.reason = reason_of(result.outcome, posterior, best.score, open, look_alike, options.verdict);
  if (result.outcome != Outcome::no_match) result.unobserved = open.list;
  const auto hypothesis = [&](std::size_t rank) {
    const std::size_t k = posterior.order[rank];
    Hypothesis stated = to_hypothesis(rank == 0 ? best : as_given(poses[k], worked), pair);
    stated.probability = posterior.probabilities[rank];
    stated.look_alike = asked.look_alike(k);
    return stated;
  };
  result.best = hypothesis(0);
  result.others = posterior.others;
  result.sigma = result.best.sigma;
  result.matches = best.refined.matches;
  result.moved = best.refined.moved;
  result.openings = matched_openings(best.refined);
  result.thickness = thickness_under(upright.refined, worked);
  result.rivals = posterior.rivals(options.verdict.risk);
  result.start = asked.agreement_with_start(leader);
  for (std::size_t k = 1; k <= count_of_alternatives(posterior, options); ++k) {
    result.alternatives.push_back(hypothesis(k));
    result.alternatives.back().tie = k <= result.rivals;
  }
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

RegistrationResult register_prepared(const PreparedPair& pair, const RegisterOptions& options,
                                     Monitor& monitor) {
  options.check();
  if (options.start) options.start->check();
  if (options.as_published)
    return register_as_published(pair, {*options.as_published, options.wall_thickness_m, options.seed},
                                 monitor);
  const WorkedPair worked = worked_pair(pair);
  RegistrationResult result;
  StageClock clock(result.stages, monitor);
  const std::vector<FoundPose> poses = find_poses(worked, options, clock);
  clock.begin("judgement");
  AskedPair asked(worked, poses, options);
  const Posterior posterior = weigh_poses(poses, sort_of(worked), asked.questions());
  clock.end();
  result.judged_poses = poses.size();
  if (poses.empty())
    result.reason = reason_of(result.outcome, posterior, {}, {}, {}, options.verdict);
  else
    write_result(poses, posterior, asked, pair, worked, options, result);
  return result;
}

}  // namespace limen
