// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "limen/model/result.h"
#include "limen/register/judge/verdict.h"

namespace limen {

struct PosteriorOptions {
  /// Evidence per m^2 of `PoseScore::value`. Pieces of surface 0.25 m apart are one observation: one in 0.4
  /// m^2. One that stands in seen free space does so with probability 0.03 under the right pose (it was
  /// moved) and 0.6 under a wrong one: 3 nats, or 7.6 per m^2, which weighs four times what agrees weighs.
  double nats_per_m2 = 1.9;
  /// The same where one scan was taken along a street: bays, storeys and windows repeat, and what meets by
  /// chance meets in rows. The best wrong poses of rooms that a street scan shows nothing of reach 9.5 m^2.
  double nats_per_m2_through_wall = 1.6;
  double search_nats_through_wall = 15.2;  ///< `search_nats`, there: 9.5 m^2
  /// What the best of all wrong poses reaches by chance: the logarithm of how many a search can tell apart
  /// (evidence times Laplace volume over search volume, for poses that are all held to about a centimetre).
  double search_nats = 9.5;
  double prior_shared = 0.5;  ///< of the pairs that are given, those that show a common place
  double unlisted = 0.1;      ///< of the pairs that share a place, those whose pose is not proposed

  void check() const;
};

/// Probabilities of the poses, in the order given, and of everything else; all of them sum to 1.
struct Posterior {
  std::vector<double> poses;
  OtherExplanations others;
  /// Of the poses after the first those that are the first one, slid along what it leaves open: one place.
  double slid = 0.0;

  [[nodiscard]] double best() const { return poses.empty() ? 0.0 : poses.front(); }
  [[nodiscard]] double place() const { return best() + slid; }
  /// That another place is right which was found.
  [[nodiscard]] double elsewhere() const;
  /// That what agrees is chance: nothing is shared, or it is shared under a pose that was not proposed.
  [[nodiscard]] double by_chance() const { return others.nothing_shared + others.unlisted_pose; }
};

/// What the judge knows of a pair.
struct PosteriorEvidence {
  double best_value_m2 = 0.0;    ///< `PoseScore::value` of the best pose
  std::vector<double> leads_m2;  ///< by how much surface speaks for the best against each other pose
  double twin = 0.0;             ///< probability that the best pose lays a place on its twin
  /// Of a scan in a model: logarithm of the odds of the best pose against chance, learned from the other
  /// poses (model_odds.h).
  std::optional<double> log_odds_of_model = {};
  /// Of each pose that was set aside, odds of a twin against one place there (hear_places.h). Where it is
  /// right after all the best pose is a twin's: it is a part of that probability. They come after the poses
  /// of `leads_m2`.
  std::vector<double> odds_of_twins = {};
  bool through_wall = false;  ///< one scan was taken in a room, the other along a street
  /// Of the value what things say that are not the building's, m^2, and by how much they speak against chance
  /// instead, natural logarithm, where they were asked one by one (twin_odds.h).
  double things_m2 = 0.0;
  double things_nats = 0.0;
  /// By how much a belief about the start makes each pose more probable, natural logarithm, the best one's
  /// first; empty: there is none (start_prior.h).
  std::vector<double> log_priors = {};
  /// `PoseScore::value` of each pose of `leads_m2`; empty: no other pose leads.
  std::vector<double> values_m2 = {};
};

/// Probability that what agrees under the best pose is chance, over that it is not.
double chance_of(const PosteriorEvidence& evidence, const PosteriorOptions& options = {});

/// Bayes' rule over the poses found, a twin, a pose not proposed, and nothing shared.
Posterior posterior(const PosteriorEvidence& evidence, const PosteriorOptions& options = {});

/// The one step from probabilities to an outcome, `open` being what the best pose leaves open.
/// - `no_match` where chance is likelier than all that is shared together;
/// - `registered` and `probable` where the best pose is as sure as the options ask for and nothing is open;
/// - `under_constrained` where something is open and the place is at least probable;
/// - else `ambiguous`.
Outcome outcome_of(const Posterior& posterior, const std::vector<UnobservedFreedom>& open,
                   const VerdictOptions& options = {});

/// A verdict that found poses, with that outcome and its reason. `twin`: what a user should know of a place
/// built alike, where one may be meant. What `judge` refuses stays refused, and what it is not sure of is
/// `ambiguous`.
Verdict decided(Verdict verdict, const Posterior& posterior, const OpenFreedoms& open,
                const std::string& twin, const VerdictOptions& options = {});

}  // namespace limen
