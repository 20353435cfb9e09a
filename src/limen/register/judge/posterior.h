// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "limen/model/result.h"
#include "limen/register/judge/found_pose.h"
#include "limen/register/judge/verdict.h"

namespace limen {

/// What a pair consists of: which numbers of the table count.
enum class PairSort : std::uint8_t {
  rooms,         ///< both scans were taken inside, or of one it is not known
  through_wall,  ///< one was taken inside, the other from a tripod outside
  past_wall,     ///< one was taken inside, the other by a vehicle that passed all windows
  streets,       ///< both were taken outside
  in_model       ///< one side is a building model
};

/// Whether one scan is of a room and the other of what is outside.
constexpr bool is_through_windows(PairSort sort) {
  return sort == PairSort::through_wall || sort == PairSort::past_wall;
}

/// Of each pose, by how much what agrees and what is contradicted exceeds what the best of all wrong poses
/// reaches by chance, natural logarithm of the odds. In a model chance is learned from the other poses
/// (model_odds.h).
std::vector<double> nats_against_chance(const std::vector<FoundPose>& poses, PairSort sort);

/// What a room and a scan from outside say of a look-alike place, the right pose not being among those found.
/// In a pair that is part of what chance reaches; but several such pairs agree on it by design. So agreeing
/// surface does not exclude it, and contradictions make it more probable. `repeats`: factor of the odds
/// beforehand.
LookAlikeEvidence look_alike_through_windows(const PoseScore& score, PairSort sort, double repeats = 1.0);

/// What the two scans say beside the scores; each is asked where it matters only.
struct PairQuestions {
  /// What distinguishes two poses, given their numbers.
  std::function<PoseContrast(std::size_t first, std::size_t second)> contrast;
  /// What is known of look-alike places under a pose: odds of 0 where they are searched, too. Null: nothing.
  std::function<LookAlikeEvidence(std::size_t pose)> look_alike;
  double repeats = 1.0;  ///< factor of the share of places that both scans see twice
};

/// Probabilities of the poses and of everything else; all of them sum to 1.
struct Posterior {
  std::vector<std::size_t> order;     ///< numbers of the poses, the likeliest first
  std::vector<double> probabilities;  ///< of these
  OtherExplanations others;
  /// Of the poses after the first those that are the first one, slid along what it leaves open: one place.
  double slid = 0.0;

  [[nodiscard]] double best() const { return probabilities.empty() ? 0.0 : probabilities.front(); }
  [[nodiscard]] double place() const { return best() + slid; }
  /// That another pose of those found is right.
  [[nodiscard]] double elsewhere() const;
  /// That what agrees is chance: nothing is shared, or it is shared under a pose that was not proposed.
  [[nodiscard]] double by_chance() const { return others.nothing_shared + others.unlisted_pose; }
  /// How many other poses have at least a hundredth of the best one's probability and are more probable than
  /// the risk: those that cannot be excluded.
  [[nodiscard]] std::size_t rivals(double risk) const;
};

/// Bayes' rule over the poses found, look-alike places, poses not proposed, and nothing shared.
///
/// One pose at most is right. What agrees under any other pose does so by chance, with the odds exp(-E), or
/// because two places look alike, with the odds T, or because the two poses resemble one another: c, which is
/// exp(-nats) of what agrees better, and is contradicted less, under that pose than under the right one.
/// Where the same two scans may see a place twice, c is at least that share, times exp(-nats) of how walls
/// were built. Against the likeliest pose l a pose k has the odds
///   (c_l + exp(-E_l) + a T_l) / (c_k + exp(-E_k) + a T_k),
/// a being the share of look-alike places whose other one the same two scans show. That the place is not
/// among the poses has the odds T_l (l is a look-alike's) and n exp(-E_l) (by chance), n beforehand.
Posterior weigh_poses(const std::vector<FoundPose>& poses, PairSort sort, const PairQuestions& questions);

/// The one step from probabilities to an outcome, `open` being what the best pose leaves open.
/// - `no_match` where chance is likelier than the best pose and than a look-alike place;
/// - `registered` and `probable` where the best pose is as sure as the options ask for and nothing is open;
/// - `under_constrained` where something is open and the place is at least probable;
/// - else `ambiguous`.
Outcome outcome_of(const Posterior& posterior, const std::vector<UnobservedFreedom>& open,
                   const VerdictOptions& options = {});

/// One sentence for a user: why this outcome. `look_alike`: of a look-alike place, where one may be meant.
std::string reason_of(Outcome outcome, const Posterior& posterior, const PoseScore& best,
                      const OpenFreedoms& open, const std::string& look_alike,
                      const VerdictOptions& options = {});

/// Of a best pose that is no answer: how much surface agrees and how much contradicts it, in words.
std::string overlap_words(double agreeing_m2, double contradicted_m2);

}  // namespace limen
