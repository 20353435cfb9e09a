// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/judge/hear_places.h"

#include <algorithm>
#include <utility>

#include "limen/register/judge/posterior.h"

namespace limen {
namespace {

class PlaceHearing {
 public:
  PlaceHearing(const std::vector<JudgedPose>& poses, const ContrastFunction& contrast,
               const VerdictOptions& options, const MatterFunction& matter)
      : poses_(poses), contrast_(contrast), options_(options), matter_(matter) {}

  std::optional<HeardPlaces> run(const Verdict& verdict) {
    if (!may_be_another(verdict)) return std::nullopt;
    ask(verdict);
    const Asked* told = nullptr;
    for (const Asked& asked : asked_) {
      const bool credible = poses_[asked.pose].score.value() >= kCredibleM2;
      if (credible && (told == nullptr || asked.wrong < told->wrong)) told = &asked;
    }
    if (told == nullptr) return std::nullopt;
    HeardPlaces heard;
    std::vector<bool> aside(poses_.size(), false);
    for (const Asked& asked : asked_) {
      const bool tells = told->wrong <= kTold || asked.said.odds() > 1.0;
      if (!tells || asked.wrong < kClearly * told->wrong || !fits_by_design(asked.pose)) continue;
      if (!elsewhere(told->pose, asked.pose)) continue;
      heard.twins.push_back({asked.pose, asked.said});
      for (std::size_t k = 0; k < poses_.size(); ++k)
        aside[k] = aside[k] || k == asked.pose || (!elsewhere(asked.pose, k) && elsewhere(told->pose, k));
    }
    if (heard.twins.empty()) return std::nullopt;
    heard.verdict = judge_without(aside);
    const std::vector<std::size_t>& ranking = heard.verdict.ranking;
    if (ranking.empty() || elsewhere(ranking.front(), told->pose)) return std::nullopt;
    if (heard.verdict.outcome == Outcome::no_match) return std::nullopt;
    return heard;
  }

 private:
  static constexpr std::size_t kMostAsked = 6;
  static constexpr double kFitsByDesignM2 = 10.0;  // so much surface does not agree by chance
  static constexpr double kCredibleM2 = 7.5;       // less is met by chance once in a hundred pairs or more
  static constexpr double kSettledM2 = 6.0;        // a lead that needs no things
  static constexpr double kTold = 0.01;            // odds that a pose is wrong below which things tell it
  static constexpr double kClearly = 20.0;         // times as probably wrong
  static constexpr double kElsewhereM = 1.0;
  static constexpr double kElsewhereRad = 0.17;

  struct Asked {
    std::size_t pose = 0;
    TwinEvidence said;
    double wrong = 0.0;  ///< odds that the pose is a twin's, or chance
  };

  [[nodiscard]] bool fits_by_design(std::size_t pose) const {
    return poses_[pose].score.agreeing_m2 >= kFitsByDesignM2;
  }

  [[nodiscard]] bool elsewhere(std::size_t a, std::size_t b) const {
    const RefinedPose& first = poses_[a].refined;
    const RefinedPose& second = poses_[b].refined;
    const Vector3d middle = inverse(first.target_from_source) * first.centre;
    return (second.target_from_source * middle - first.centre).norm() > kElsewhereM ||
           rotation_angle(first.target_from_source.rotation.transpose() *
                          second.target_from_source.rotation) > kElsewhereRad;
  }

  /// Whether surface leaves it open which of several places is right, one of which may fit by design, or
  /// things refute what surface tells.
  [[nodiscard]] bool may_be_another(const Verdict& verdict) const {
    const std::size_t best = verdict.ranking.front();
    const bool registered = verdict.outcome == Outcome::registered;
    bool any = false;
    for (auto other = verdict.ranking.begin() + 1; other != verdict.ranking.end(); ++other) {
      const bool both = fits_by_design(best) || fits_by_design(*other);
      const bool credible =
          poses_[best].score.value() >= kCredibleM2 || poses_[*other].score.value() >= kCredibleM2;
      if (!both || !credible || !elsewhere(best, *other)) continue;
      if (!registered) return true;
      const PoseContrast apart = contrast_(best, *other);
      if (apart.for_first_m2 - apart.for_second_m2 < kSettledM2) return true;
      any = any || poses_[*other].score.value() >= kCredibleM2;
    }
    return any && weigh_twin(matter_(poses_[best].refined), options_.twin).odds() > 1.0;
  }

  /// Asks things of the best poses of several places.
  void ask(const Verdict& verdict) {
    for (const std::size_t pose : verdict.ranking) {
      if (asked_.size() >= kMostAsked) return;
      if (!fits_by_design(pose) && poses_[pose].score.value() < kCredibleM2) continue;
      const bool known = std::any_of(asked_.begin(), asked_.end(),
                                     [&](const Asked& asked) { return !elsewhere(asked.pose, pose); });
      if (known) continue;
      PosteriorEvidence surface;
      surface.best_value_m2 = poses_[pose].score.value();
      Asked asked{pose, weigh_twin(matter_(poses_[pose].refined), options_.twin), 0.0};
      asked.wrong = asked.said.odds() + chance_of(surface);
      asked_.push_back(asked);
    }
  }

  [[nodiscard]] Verdict judge_without(const std::vector<bool>& aside) const {
    std::vector<JudgedPose> rest;
    std::vector<std::size_t> number;
    for (std::size_t k = 0; k < poses_.size(); ++k) {
      if (aside[k]) continue;
      rest.push_back(poses_[k]);
      number.push_back(k);
    }
    Verdict verdict = judge(
        rest, [&](std::size_t a, std::size_t b) { return contrast_(number[a], number[b]); }, options_);
    for (std::vector<std::size_t>* list : {&verdict.ranking, &verdict.rivals}) {
      for (std::size_t& pose : *list) pose = number[pose];
    }
    return verdict;
  }

  const std::vector<JudgedPose>& poses_;
  const ContrastFunction& contrast_;
  const VerdictOptions& options_;
  const MatterFunction& matter_;
  std::vector<Asked> asked_;
};

}  // namespace

std::optional<HeardPlaces> hear_past_twins(const std::vector<JudgedPose>& poses, const Verdict& verdict,
                                           const ContrastFunction& contrast, const MatterFunction& matter,
                                           const VerdictOptions& options) {
  if (verdict.ranking.size() < 2) return std::nullopt;
  return PlaceHearing(poses, contrast, options, matter).run(verdict);
}

}  // namespace limen
