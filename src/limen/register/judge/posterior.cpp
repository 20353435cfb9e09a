// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/judge/posterior.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include <fmt/format.h>

#include "limen/base/text.h"
#include "limen/geometry/rigid.h"
#include "limen/model/look_alike_evidence.h"
#include "limen/register/judge/as_built.h"
#include "limen/register/judge/evidence_table.h"
#include "limen/register/judge/look_alike_odds.h"
#include "limen/register/judge/model_odds.h"

namespace limen {
namespace {

const evidence_table::Surface& table_of(PairSort sort) {
  switch (sort) {
    case PairSort::through_wall:
      return evidence_table::kThroughWall;
    case PairSort::past_wall:
      return evidence_table::kPastWall;
    case PairSort::streets:
      return evidence_table::kStreets;
    case PairSort::in_model:
      return evidence_table::kInModel;
    case PairSort::rooms:
      break;
  }
  return evidence_table::kRooms;
}

/// Of every pose in a model against chance: the share of the scan's walls that are the model's takes the
/// place of the surface that wrong poses reach, which the other poses show.
std::vector<double> nats_in_model(const std::vector<FoundPose>& poses) {
  const evidence_table::Surface& table = evidence_table::kInModel;
  std::vector<WallBalance> walls;
  for (const FoundPose& pose : poses) walls.push_back(pose.walls);
  std::vector<double> nats = log_odds_of_model(walls);
  double by_chance_m2 = 0.0;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    if (nats[k] <= 0.0) by_chance_m2 = std::max(by_chance_m2, poses[k].score.value());
  }
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const PoseScore& score = poses[k].score;
    const double by_contradiction =
        nats_of_contradiction(score.agreeing_m2, score.contradicted_m2, table.contradicted);
    // That nothing is contradicted does not make walls of another building the model's. More walls of the
    // model never make a pose worse.
    const double by_surface = table.nats_per_m2 * (score.value() - by_chance_m2) + by_contradiction;
    const double without_walls = std::min(0.0, by_contradiction);
    nats[k] = nats[k] > 0.0 ? std::max(nats[k] + by_surface, without_walls) : nats[k] + without_walls;
  }
  return nats;
}

constexpr double kMostNats = 500.0;  // exp() of more may be infinite

/// Asks each question once, and only where the answer matters.
class Weighing {
 public:
  Weighing(const std::vector<FoundPose>& poses, PairSort sort, const PairQuestions& questions)
      : poses_(poses),
        sort_(sort),
        table_(table_of(sort)),
        questions_(questions),
        against_chance_(nats_against_chance(poses, sort)),
        look_alikes_(poses.size()) {
    for (std::size_t k = 1; k < poses.size(); ++k) {
      if (against_chance_[k] + poses[k].log_prior > against_chance_[first_] + poses[first_].log_prior)
        first_ = k;
    }
  }

  /// The pose that surface and beliefs make likeliest.
  [[nodiscard]] std::size_t first() const { return first_; }
  /// Odds that a pose lays a place on a look-alike one.
  [[nodiscard]] double look_alike(std::size_t pose) {
    return questions_.look_alike ? limen::odds_of(evidence_of(pose)) : 0.0;
  }
  /// By how much what agrees under a pose exceeds chance, nats.
  [[nodiscard]] double against_chance(std::size_t pose) {
    if (!questions_.look_alike) return against_chance_[pose];
    return against_chance_[pose] + otherwise_nats(evidence_of(pose)) + table_.built * as_built(pose);
  }
  /// Whether a pose may be right: of the many that are refined in a model those that exceed chance, and the
  /// best.
  [[nodiscard]] bool is_candidate(std::size_t pose) const {
    return sort_ != PairSort::in_model || against_chance_[pose] + poses_[pose].log_prior > 0.0 ||
           pose == first_;
  }
  /// Odds of each pose against the one that leads.
  [[nodiscard]] std::vector<double> odds_against(std::size_t leader) {
    std::vector<double> odds(poses_.size(), 0.0);
    odds[leader] = 1.0;
    for (std::size_t k = 0; k < poses_.size(); ++k) {
      if (k != leader && is_candidate(k)) odds[k] = odds_of(k, leader);
    }
    return odds;
  }

 private:
  static constexpr double kNegligible = 1e-7;

  [[nodiscard]] const LookAlikeEvidence& evidence_of(std::size_t pose) {
    if (!look_alikes_[pose]) look_alikes_[pose] = questions_.look_alike(pose);
    return *look_alikes_[pose];
  }
  /// What the millimetres of walls say for one place, nats.
  [[nodiscard]] double as_built(std::size_t pose) {
    return questions_.look_alike ? built_nats(evidence_of(pose).built) : 0.0;
  }
  // Logarithms, for the odds of large scans may underflow.

  /// That a pose agrees though another one is right which resembles it, by chance or because the building
  /// has the same place twice, which is built otherwise by millimetres. That does not explain what the other
  /// one contradicts. `share`: of the other one among all that may be the place seen twice.
  [[nodiscard]] double log_resembling(std::size_t pose, double more_agrees_m2, double less_contradicted_m2,
                                      double share) {
    const double twice = questions_.repeats * table_.twice * share;
    const double by_chance = std::log1p(-twice) - table_.contrast_per_m2 * more_agrees_m2;
    const double both = twice > 0.0 ? log_sum_exp({by_chance, std::log(twice) - as_built(pose)}) : by_chance;
    return both - table_.against_per_m2 * less_contradicted_m2;
  }
  /// Without look-alike places.
  [[nodiscard]] double log_wrong_here(double log_resembling, std::size_t pose) {
    return log_sum_exp({log_resembling, -against_chance(pose)});
  }
  [[nodiscard]] double log_wrong(double log_resembling, std::size_t pose) {
    return log_sum_exp({log_wrong_here(log_resembling, pose),
                        std::log(evidence_table::kInPair) + std::log(look_alike(pose))});
  }
  /// Whether two poses are so near each other that they cannot be two places built alike.
  [[nodiscard]] bool are_one_place(std::size_t a, std::size_t b) const {
    const RefinedPose& first = poses_[a].refined;
    const Rigid3 apart = poses_[b].refined.target_from_source * inverse(first.target_from_source);
    return (apart * first.centre - first.centre).norm() < kOtherPlaceM &&
           rotation_angle(apart.rotation) < kOtherPlaceRad;
  }
  /// Share of a pose among all but `another`, by how much each exceeds chance; 0 where no place is seen
  /// twice.
  [[nodiscard]] double share_of(std::size_t pose, std::size_t another) const {
    if (table_.twice <= 0.0) return 0.0;
    double all = 0.0;
    for (std::size_t k = 0; k < poses_.size(); ++k) {
      if (k != another) all += std::exp(std::min(kMostNats, against_chance_[k] - against_chance_[pose]));
    }
    return 1.0 / all;
  }
  [[nodiscard]] double odds_of(std::size_t pose, std::size_t leader) {
    const PoseContrast contrast = questions_.contrast(leader, pose);
    const double leads =
        log_resembling(leader, contrast.for_first_m2, contrast.against_second_m2, share_of(pose, leader));
    // A pose beside the leader lays no other place there.
    const double right =
        poses_[pose].log_prior - poses_[leader].log_prior +
        (are_one_place(leader, pose) ? log_wrong_here(leads, leader) : log_wrong(leads, leader));
    const double resembles =
        log_resembling(pose, contrast.for_second_m2, contrast.against_first_m2, share_of(leader, pose));
    const bool negligible = right - resembles < std::log(kNegligible);
    return std::exp(std::min(kMostNats, right - (negligible ? resembles : log_wrong(resembles, pose))));
  }

  const std::vector<FoundPose>& poses_;
  PairSort sort_;
  const evidence_table::Surface& table_;
  const PairQuestions& questions_;
  std::vector<double> against_chance_;
  std::size_t first_ = 0;
  std::vector<std::optional<LookAlikeEvidence>> look_alikes_;
};

}  // namespace

std::vector<double> nats_against_chance(const std::vector<FoundPose>& poses, PairSort sort) {
  if (sort == PairSort::in_model) return nats_in_model(poses);
  const evidence_table::Surface& table = table_of(sort);
  std::vector<double> nats;
  for (const FoundPose& pose : poses) {
    nats.push_back(
        table.nats_per_m2 * pose.score.evidence_m2 +
        nats_of_contradiction(pose.score.agreeing_m2, pose.score.contradicted_m2, table.contradicted) -
        table.search_nats);
  }
  return nats;
}

LookAlikeEvidence look_alike_through_windows(const PoseScore& score, PairSort sort, double repeats) {
  const evidence_table::Surface& table = table_of(sort);
  LookAlikeEvidence evidence;
  evidence.rooms = false;
  evidence.otherwise = repeats * evidence_table::kBehindWindows;
  evidence.alike = evidence.otherwise * evidence_table::kAlike / evidence_table::kOtherwise;
  const double against = nats_of_contradiction(score.agreeing_m2, score.contradicted_m2, table.contradicted);
  evidence.otherwise_nats.fill(against);
  evidence.alike_nats.fill(against);
  return evidence;
}

Posterior weigh_poses(const std::vector<FoundPose>& poses, PairSort sort, const PairQuestions& questions) {
  Posterior posterior;
  if (poses.empty()) {
    posterior.others.nothing_shared = 1.0;
    return posterior;
  }
  const evidence_table::Surface& table = table_of(sort);
  Weighing weighing(poses, sort, questions);
  std::vector<std::size_t> numbers(poses.size());
  std::iota(numbers.begin(), numbers.end(), std::size_t{0});
  std::size_t leader = weighing.first();
  std::vector<double> odds;
  std::vector<bool> has_led(poses.size(), false);  // contrasts are not transitive: each leads once
  for (;;) {
    odds = weighing.odds_against(leader);
    has_led[leader] = true;
    std::size_t next = leader;
    for (const std::size_t k : numbers) {
      if (!has_led[k] && odds[k] > odds[next]) next = k;
    }
    if (next == leader) break;
    leader = next;
  }
  const double chance =
      std::exp(std::min(kMostNats, -weighing.against_chance(leader) - poses[leader].log_prior));
  posterior.others.look_alike = weighing.look_alike(leader);
  posterior.others.nothing_shared = table.nothing_shared * chance;
  posterior.others.unlisted_pose = table.unlisted * chance;
  posterior.order = numbers;
  std::stable_sort(posterior.order.begin(), posterior.order.end(), [&](std::size_t a, std::size_t b) {
    if (a == leader || b == leader) return a == leader && b != leader;
    return odds[a] > odds[b];
  });
  OtherExplanations& others = posterior.others;
  double total = others.look_alike + others.nothing_shared + others.unlisted_pose;
  for (const double one : odds) total += one;
  for (double* other : {&others.look_alike, &others.nothing_shared, &others.unlisted_pose}) *other /= total;
  for (const std::size_t k : posterior.order) posterior.probabilities.push_back(odds[k] / total);
  return posterior;
}

double Posterior::elsewhere() const {
  if (probabilities.empty()) return 0.0;
  return std::accumulate(probabilities.begin() + 1, probabilities.end(), 0.0) - slid;
}

std::size_t Posterior::rivals(double risk) const {
  constexpr double kComparable = 0.01;
  if (probabilities.empty()) return 0;
  const double least = std::max(risk, kComparable * best());
  return static_cast<std::size_t>(std::count_if(probabilities.begin() + 1, probabilities.end(),
                                                [&](double one) { return one >= least; }));
}

Outcome outcome_of(const Posterior& posterior, const std::vector<UnobservedFreedom>& open,
                   const VerdictOptions& options) {
  const double chance = posterior.by_chance();
  if (posterior.order.empty() || chance > std::max(posterior.place(), posterior.others.look_alike))
    return Outcome::no_match;
  const double probable = 1.0 - options.probable_risk;
  if (!open.empty()) return posterior.place() >= probable ? Outcome::under_constrained : Outcome::ambiguous;
  if (posterior.best() >= 1.0 - options.risk) return Outcome::registered;
  return posterior.best() >= probable ? Outcome::probable : Outcome::ambiguous;
}

namespace {

/// The likeliest of what else may be.
std::string what_else(const Posterior& posterior, const std::string& look_alike) {
  const double chance = posterior.by_chance();
  const double elsewhere = posterior.elsewhere();
  if (posterior.others.look_alike >= std::max(chance, elsewhere) && !look_alike.empty()) return look_alike;
  if (chance > elsewhere)
    return fmt::format("the overlap is so small that it may be chance ({})", percent_words(chance));
  return fmt::format("the overlap does not exclude the other poses: one of them may be right ({})",
                     percent_words(elsewhere));
}

/// Cut, not rounded: what is below a limit does not read as if it reached it.
std::string placed_words(double probability, double risk) {
  const int digits = probability < 0.99 ? 1 : 2;
  const double scale = probability < 0.99 ? 1e3 : 1e4;
  return fmt::format("probability {:.{}f} % ({:g} % is needed for registered)",
                     100.0 * std::floor(scale * probability + 1e-9) / scale, digits, 100.0 * (1.0 - risk));
}

std::string why_open(OpenFreedoms::Cause cause) {
  switch (cause) {
    case OpenFreedoms::Cause::drift:
      return "the trajectory drifts, so the scans do not fix the ";
    case OpenFreedoms::Cause::moved:
      return "planes were moved between the scans, so these do not fix the ";
    case OpenFreedoms::Cause::surface:
      break;
  }
  return "the common surface does not fix the ";
}

}  // namespace

std::string reason_of(Outcome outcome, const Posterior& posterior, const PoseScore& best,
                      const OpenFreedoms& open, const std::string& look_alike,
                      const VerdictOptions& options) {
  switch (outcome) {
    case Outcome::registered:
      return fmt::format(
          "{:.1f} m2 of surface agree, {:.1f} m2 contradict, and no other pose fits nearly as well",
          best.agreeing_m2, best.contradicted_m2);
    case Outcome::probable:
      return placed_words(posterior.best(), options.risk) + ": " + what_else(posterior, look_alike);
    case Outcome::under_constrained:
      return why_open(open.cause) + open.list.front().name;
    case Outcome::ambiguous:
      return what_else(posterior, look_alike);
    case Outcome::no_match:
      break;
  }
  if (posterior.order.empty()) return "no planes of the two scans match";
  return fmt::format("{}: no single pose is as likely as that the scans do not overlap ({})",
                     overlap_words(best.agreeing_m2, best.contradicted_m2),
                     percent_words(posterior.by_chance()));
}

std::string overlap_words(double agreeing_m2, double contradicted_m2) {
  constexpr double kLeastShownM2 = 0.05;  // less would read 0.0
  if (contradicted_m2 < kLeastShownM2)
    return fmt::format("best overlap {:.1f} m2, which may be chance", agreeing_m2);
  return fmt::format(
      "best overlap {:.1f} m2, but it puts {:.1f} m2 of surface where the other scanner saw empty space",
      agreeing_m2, contradicted_m2);
}

}  // namespace limen
