// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/judge/verdict.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "limen/base/angles.h"
#include "limen/base/error.h"
#include "limen/geometry/linear.h"
#include "limen/register/judge/posterior.h"

namespace limen {
namespace {

bool same_pose(const RefinedPose& a, const RefinedPose& b, const VerdictOptions& options) {
  const Matrix3d turn = a.target_from_source.rotation.transpose() * b.target_from_source.rotation;
  if (rotation_angle(turn) > radians(options.same_rotation_deg)) return false;
  // Where both poses put the middle of the surface matched by the first.
  const Vector3d middle = inverse(a.target_from_source) * a.centre;
  return (b.target_from_source * middle - a.centre).norm() <= options.same_shift_m;
}

/// Whether two poses differ only along shifts that the first leaves open.
bool same_but_for(const RefinedPose& a, const RefinedPose& b, const std::vector<UnobservedFreedom>& open,
                  const VerdictOptions& options) {
  const Matrix3d turn = a.target_from_source.rotation.transpose() * b.target_from_source.rotation;
  if (rotation_angle(turn) > radians(options.same_rotation_deg)) return false;
  const Vector3d middle = inverse(a.target_from_source) * a.centre;
  Vector3d shift = b.target_from_source * middle - a.centre;
  for (const UnobservedFreedom& freedom : open) shift -= freedom.direction.dot(shift) * freedom.direction;
  return shift.norm() <= options.same_shift_m;
}

bool contradicted(const PoseScore& score, const VerdictOptions& options) {
  const double evidence = std::min(1.0, score.agreeing_m2 / options.full_evidence_m2);
  return score.contradicted_m2 > options.max_contradiction * evidence * score.agreeing_m2;
}

/// Whether a pose through a wall is borne out by no opening and contradicted more than a right one would be.
bool unsure_through_wall(const PoseScore& score, const VerdictOptions& options) {
  return options.through_wall && score.opening_m2 <= 0.0 &&
         score.contradicted_m2 >
             options.max_unopened_contradiction * score.agreeing_m2 + options.unopened_allowance_m2;
}

/// Whether `other` comes near the best and is possible at all: what speaks for it is not outweighed by what
/// it contradicts, and it does not contradict clearly more than the best.
bool possible(const PoseScore& other, const PoseScore& best, const VerdictOptions& options) {
  const double bearable = best.contradicted_m2 + options.excess_contradiction_m2 +
                          options.excess_contradiction_share * other.agreeing_m2;
  return other.value() > 0 && other.value() > options.min_rival_value * best.value() &&
         other.contradicted_m2 <= options.max_rival_contradiction * other.agreeing_m2 &&
         other.contradicted_m2 <= bearable;
}

/// A pose that this much less surface speaks for than for the best is less probable than the risk
/// (posterior.h).
double clear_lead_m2(const VerdictOptions& options) {
  const PosteriorOptions posterior;
  return std::log((1.0 - options.risk) / options.risk) /
         (options.through_wall ? posterior.nats_per_m2_through_wall : posterior.nats_per_m2);
}

bool is_rival(PoseContrast contrast, double prior_lead_m2, const VerdictOptions& options) {
  (prior_lead_m2 > 0 ? contrast.for_first_m2 : contrast.for_second_m2) += std::abs(prior_lead_m2);
  const double lead = contrast.for_first_m2 - contrast.for_second_m2;
  return lead < options.min_lead_m2 ||
         (lead < clear_lead_m2(options) &&
          contrast.for_second_m2 > options.max_rival_share * contrast.for_first_m2);
}

/// A pose that may still turn, or slide two ways and more, is no answer.
bool too_loose(const std::vector<UnobservedFreedom>& unobserved) {
  const bool turns =
      std::any_of(unobserved.begin(), unobserved.end(), [](const auto& f) { return f.rotation; });
  return turns || unobserved.size() > 2;
}

std::string direction_name(const Vector3d& d) {
  if (std::abs(d.z()) > 0.996) return "the vertical";
  return fmt::format("({:.2f}, {:.2f}, {:.2f})", d.x(), d.y(), d.z());
}

/// The direction with its largest part positive: a freedom has no sign.
Vector3d positive(const Vector3d& d) {
  Eigen::Index largest = 0;
  d.cwiseAbs().maxCoeff(&largest);
  return d[largest] < 0 ? Vector3d(-d) : d;
}

/// Directions in which a 3 x 3 information (m^2) is below the bound.
void add_weak(const Matrix3d& information, double bound, bool rotation,
              std::vector<UnobservedFreedom>& weak) {
  const Spectrum3 spectrum = spectrum_of(information);
  for (Eigen::Index k = 0; k < 3; ++k) {
    if (spectrum.values[k] >= bound) continue;
    const Vector3d d = positive(spectrum.vectors.col(k));
    weak.push_back({rotation, d, (rotation ? "turn about " : "shift along ") + direction_name(d)});
  }
}

}  // namespace

void VerdictOptions::check() const {
  if (!(min_agreeing_m2 > 0)) throw_bad_option("min_agreeing_m2", min_agreeing_m2, "more than 0");
  if (!(max_contradiction > 0)) throw_bad_option("max_contradiction", max_contradiction, "more than 0");
  model_odds.check();
  if (!(max_rival_share > 0 && max_rival_share < 1)) {
    throw_bad_option("max_rival_share", max_rival_share, "within (0, 1)");
  }
  if (!(risk > 0 && risk < 0.5)) throw_bad_option("risk", risk, "within (0, 0.5)");
  if (!(probable_risk > risk && probable_risk < 0.5))
    throw_bad_option("probable_risk", probable_risk, fmt::format("within ({:g}, 0.5), above the risk", risk));
  twin.check();
  if (!(max_sigma_m > 0)) throw_bad_option("max_sigma_m", max_sigma_m, "more than 0");
  if (!(max_sigma_deg > 0)) throw_bad_option("max_sigma_deg", max_sigma_deg, "more than 0");
  if (!(max_drifting_m > 0)) throw_bad_option("max_drifting_m", max_drifting_m, "more than 0");
  if (!(max_drifting_deg > 0)) throw_bad_option("max_drifting_deg", max_drifting_deg, "more than 0");
  if (!(min_held_m2 > 0)) throw_bad_option("min_held_m2", min_held_m2, "more than 0");
  // Nothing is more or less than a number that is none: such a bound would let any pose pass.
  const std::pair<const char*, double> bounds[] = {{"max_contradiction_in_use", max_contradiction_in_use},
                                                   {"full_evidence_m2", full_evidence_m2},
                                                   {"max_unopened_contradiction", max_unopened_contradiction},
                                                   {"unopened_allowance_m2", unopened_allowance_m2},
                                                   {"max_model_contradiction", max_model_contradiction},
                                                   {"model_allowance_m2", model_allowance_m2},
                                                   {"max_rival_contradiction", max_rival_contradiction},
                                                   {"excess_contradiction_m2", excess_contradiction_m2},
                                                   {"excess_contradiction_share", excess_contradiction_share},
                                                   {"min_rival_value", min_rival_value},
                                                   {"min_lead_m2", min_lead_m2},
                                                   {"same_rotation_deg", same_rotation_deg},
                                                   {"same_shift_m", same_shift_m}};
  for (const auto& [name, value] : bounds) {
    if (!(value >= 0)) throw_bad_option(name, value, "0 or more");
  }
}

std::vector<UnobservedFreedom> unobserved_freedoms(const RefinedPose& pose, double min_held_m2) {
  const Matrix3d turns = pose.geometry_m2.topLeftCorner<3, 3>();
  const Matrix3d shifts = pose.geometry_m2.bottomRightCorner<3, 3>();
  const Matrix3d mixed = pose.geometry_m2.topRightCorner<3, 3>();
  const Matrix3d damping = 1e-9 * Matrix3d::Identity();
  // What is left of each block once the other is free (Schur complements).
  const Matrix3d shift_held = shifts - mixed.transpose() * (turns + damping).inverse() * mixed;
  const Matrix3d turn_held = turns - mixed * (shifts + damping).inverse() * mixed.transpose();
  std::vector<UnobservedFreedom> weak;
  add_weak(shift_held, min_held_m2, false, weak);
  add_weak(turn_held, 0.25 * min_held_m2, true, weak);
  return weak;
}

std::vector<UnobservedFreedom> loose_freedoms(const Matrix6d& covariance, double max_sigma_m,
                                              double max_sigma_deg) {
  std::vector<UnobservedFreedom> loose;
  const Spectrum3 shifts = spectrum_of(Matrix3d(covariance.bottomRightCorner<3, 3>()));
  const Spectrum3 turns = spectrum_of(Matrix3d(covariance.topLeftCorner<3, 3>()));
  for (Eigen::Index k = 0; k < 3; ++k) {
    const double sigma_m = std::sqrt(std::max(0.0, shifts.values[k]));
    const double sigma_deg = degrees(std::sqrt(std::max(0.0, turns.values[k])));
    const Vector3d along = positive(shifts.vectors.col(k));
    const Vector3d about = positive(turns.vectors.col(k));
    if (sigma_m > max_sigma_m) {
      loose.push_back({false, along,
                       fmt::format("shift along {}, known to {:.0f} mm only", direction_name(along),
                                   1e3 * std::min(sigma_m, 10.0))});
    }
    if (sigma_deg > max_sigma_deg) {
      loose.push_back({true, about,
                       fmt::format("turn about {}, known to {:.2f} deg only", direction_name(about),
                                   std::min(sigma_deg, 180.0))});
    }
  }
  return loose;
}

std::vector<std::size_t> rank(const std::vector<JudgedPose>& poses, const VerdictOptions& options) {
  std::vector<std::size_t> order(poses.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return poses[a].value() > poses[b].value(); });
  std::vector<std::size_t> distinct;
  for (const std::size_t i : order) {
    const bool known = std::any_of(distinct.begin(), distinct.end(), [&](std::size_t j) {
      return same_pose(poses[j].refined, poses[i].refined, options);
    });
    if (!known) distinct.push_back(i);
  }
  return distinct;
}

namespace {

/// Of each pose of a ranking in a model the odds that its walls are the model's, and by how much its value
/// exceeds that of the best pose that chance explains.
struct ModelRanking {
  std::vector<std::size_t> poses;  ///< those that the model explains better than chance does
  std::vector<double> log_odds;
  double log_odds_of_first = 0.0;  ///< of the ranking's first, whether it is one of them or not
};

ModelRanking ranking_in_model(const std::vector<JudgedPose>& poses, const std::vector<std::size_t>& ranking,
                              const VerdictOptions& options) {
  std::vector<WallBalance> walls;
  for (const std::size_t i : ranking) walls.push_back(poses[i].walls);
  const std::vector<double> odds = log_odds_of_model(walls, options.model_odds);
  double by_chance = 0.0;
  for (std::size_t k = 0; k < odds.size(); ++k) {
    if (odds[k] <= 0) by_chance = std::max(by_chance, poses[ranking[k]].score.value());
  }
  ModelRanking left;
  left.log_odds_of_first = odds.front();
  for (std::size_t k = 0; k < odds.size(); ++k) {
    if (odds[k] <= 0) continue;
    left.poses.push_back(ranking[k]);
    left.log_odds.push_back(odds[k] +
                            options.model_odds.nats_per_m2 * (poses[ranking[k]].score.value() - by_chance));
  }
  return left;
}

/// Leaves those poses of a ranking in a model whose walls the model explains better than chance does, and
/// tells the odds of the best of them. False where chance is the better explanation of all of them.
bool leave_chance_out(const std::vector<JudgedPose>& poses, const VerdictOptions& options, Verdict& verdict) {
  const ModelRanking left = ranking_in_model(poses, verdict.ranking, options);
  const std::size_t best = left.poses.empty() ? verdict.ranking.front() : left.poses.front();
  verdict.log_odds_of_model = left.poses.empty() ? left.log_odds_of_first : left.log_odds.front();
  verdict.ranking = left.poses;
  if (verdict.log_odds_of_model > 0) return true;
  verdict.ranking = {best};
  verdict.reason = fmt::format(
      "at best {:.0f} % of the walls that the scan saw are in the model, as chance has it: it was taken "
      "elsewhere, or much was built otherwise",
      100.0 * poses[best].walls.share());
  return false;
}

/// Whether a pose in a model may agree by chance after all, with more than the bearable probability.
bool may_be_chance(const Verdict& verdict, const VerdictOptions& options) {
  return options.in_model && verdict.log_odds_of_model < std::log((1.0 - options.risk) / options.risk);
}

}  // namespace

Verdict judge(const std::vector<JudgedPose>& poses, const ContrastFunction& contrast,
              const VerdictOptions& options) {
  options.check();
  Verdict verdict;
  verdict.ranking = rank(poses, options);
  if (verdict.ranking.empty()) {
    verdict.reason = "no planes of the two scans can be laid on one another";
    return verdict;
  }
  if (options.in_model && !leave_chance_out(poses, options, verdict)) return verdict;
  const JudgedPose& best = poses[verdict.ranking.front()];
  if (best.score.planar_m2 < options.min_agreeing_m2) {
    double most_m2 = 0.0;
    for (const std::size_t i : verdict.ranking) most_m2 = std::max(most_m2, poses[i].score.planar_m2);
    verdict.reason = most_m2 < options.min_agreeing_m2
                         ? fmt::format("the scans have only {:.1f} m2 of surface in common at best", most_m2)
                         : fmt::format(
                               "where most surface agrees, {:.1f} m2, too much stands in seen free space; "
                               "where little does only {:.1f} m2 agree",
                               most_m2, best.score.planar_m2);
    return verdict;
  }
  if (contradicted(best.score, options) || (options.in_model && best.score.value() <= 0.0)) {
    verdict.reason =
        fmt::format("at best {:.1f} m2 agree, but {:.1f} m2 of one scan stand where the other saw free space",
                    best.score.agreeing_m2, best.score.contradicted_m2);
    return verdict;
  }
  verdict.unobserved = unobserved_freedoms(best.refined, options.min_held_m2);
  if (too_loose(verdict.unobserved)) {
    verdict.unobserved.clear();
    verdict.reason = fmt::format("the {:.1f} m2 of surface in common do not even fix the rotation",
                                 best.score.agreeing_m2);
    return verdict;
  }
  for (std::size_t k = 1; k < verdict.ranking.size(); ++k) {
    const std::size_t other = verdict.ranking[k];
    if (!possible(poses[other].score, best.score, options)) continue;
    if (same_but_for(best.refined, poses[other].refined, verdict.unobserved, options)) continue;
    if (is_rival(contrast(verdict.ranking.front(), other), best.prior_m2 - poses[other].prior_m2, options))
      verdict.rivals.push_back(other);
  }
  const std::size_t rivals = verdict.rivals.size();
  if (rivals > 0) {
    verdict.outcome = Outcome::ambiguous;
    verdict.reason = fmt::format("{} different pose{} explain{} the scans nearly as well", rivals,
                                 rivals == 1 ? "" : "s", rivals == 1 ? "s" : "");
    return verdict;
  }
  if (options.in_model &&
      best.score.contradicted_m2 >
          options.max_model_contradiction * best.score.agreeing_m2 + options.model_allowance_m2) {
    verdict.outcome = Outcome::ambiguous;
    verdict.unsure = true;
    verdict.reason = fmt::format(
        "{:.1f} m2 of the model stand where the scan saw free space: another room, or built "
        "otherwise",
        best.score.contradicted_m2);
    return verdict;
  }
  if (may_be_chance(verdict, options)) {
    verdict.outcome = Outcome::ambiguous;
    verdict.reason = fmt::format(
        "{:.0f} % of the walls that the scan saw are in the model, which chance explains with a probability "
        "of "
        "{:.2g}",
        100.0 * best.walls.share(), 1.0 / (1.0 + std::exp(verdict.log_odds_of_model)));
    return verdict;
  }
  if (unsure_through_wall(best.score, options)) {
    verdict.outcome = Outcome::ambiguous;
    verdict.unsure = true;
    verdict.reason = fmt::format(
        "no opening is seen from both sides, and {:.1f} m2 of one scan stand where the other saw free space",
        best.score.contradicted_m2);
    return verdict;
  }
  if (verdict.unobserved.empty()) {
    verdict.unobserved =
        loose_freedoms(covariance_of(best.refined), options.max_sigma_m, options.max_sigma_deg);
  }
  if (!verdict.unobserved.empty()) {
    verdict.outcome = Outcome::under_constrained;
    verdict.reason = "the common surface does not fix the " + verdict.unobserved.front().name;
    return verdict;
  }
  verdict.outcome = Outcome::registered;
  verdict.reason =
      fmt::format("{:.1f} m2 of surface agree, {:.1f} m2 are contradicted, no different pose comes near",
                  best.score.agreeing_m2, best.score.contradicted_m2);
  return verdict;
}

namespace {

/// Whether a pose would be an answer, were it the best.
bool may_lead(const JudgedPose& pose, const VerdictOptions& options) {
  return pose.score.planar_m2 >= options.min_agreeing_m2 && !contradicted(pose.score, options) &&
         !too_loose(unobserved_freedoms(pose.refined, options.min_held_m2));
}

}  // namespace

Verdict led_by_likeliest(Verdict verdict, const std::vector<JudgedPose>& poses,
                         const ContrastFunction& contrast, const VerdictOptions& options) {
  if (verdict.outcome != Outcome::ambiguous || verdict.rivals.empty()) return verdict;
  const std::size_t first = verdict.ranking.front();
  std::size_t leader = first;
  std::vector<std::size_t> asked = verdict.rivals;  // contrasts are not transitive: each leads once
  for (;;) {
    double most_m2 = 0.0;
    std::size_t next = leader;
    for (const std::size_t other : asked) {
      const PoseContrast apart = contrast(leader, other);
      const double lead_m2 =
          apart.for_second_m2 - apart.for_first_m2 + poses[other].prior_m2 - poses[leader].prior_m2;
      if (lead_m2 <= most_m2 || !may_lead(poses[other], options)) continue;
      most_m2 = lead_m2;
      next = other;
    }
    if (next == leader) break;
    leader = next;
    asked.erase(std::remove(asked.begin(), asked.end(), leader), asked.end());
  }
  if (leader == first) return verdict;
  if (options.in_model) {
    const ModelRanking all = ranking_in_model(poses, rank(poses, options), options);
    const auto found = std::find(all.poses.begin(), all.poses.end(), leader);
    verdict.log_odds_of_model = all.log_odds[static_cast<std::size_t>(found - all.poses.begin())];
  }
  std::replace(verdict.rivals.begin(), verdict.rivals.end(), leader, first);
  const auto place = std::find(verdict.ranking.begin(), verdict.ranking.end(), leader);
  std::rotate(verdict.ranking.begin(), place, place + 1);
  verdict.unobserved = unobserved_freedoms(poses[leader].refined, options.min_held_m2);
  verdict.reason =
      "what tells it from another pose speaks for it, but more surface agrees under that other one";
  return verdict;
}

OpenFreedoms open_freedoms(const RefinedPose& pose, const Matrix6d& with_drift,
                           const VerdictOptions& options) {
  OpenFreedoms open{unobserved_freedoms(pose, options.min_held_m2)};
  if (open.list.empty())
    open.list = loose_freedoms(covariance_of(pose), options.max_sigma_m, options.max_sigma_deg);
  if (!open.list.empty()) return open;
  open.list = loose_freedoms(with_drift, options.max_drifting_m, options.max_drifting_deg);
  open.by_drift = !open.list.empty();
  return open;
}

bool is_slid(const RefinedPose& first, const RefinedPose& second, const VerdictOptions& options) {
  const std::vector<UnobservedFreedom> open = unobserved_freedoms(first, options.min_held_m2);
  return !open.empty() && same_but_for(first, second, open, options);
}

}  // namespace limen
