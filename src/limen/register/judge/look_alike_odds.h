// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "limen/model/look_alike_evidence.h"
#include "limen/register/judge/evidence_table.h"
#include "limen/register/judge/seen_clutter.h"

namespace limen {

/// Odds beforehand that a pose whose walls agree lays a place on a look-alike place.
struct LookAlikeOptions {
  double otherwise = evidence_table::kOtherwise;  ///< that is furnished otherwise ...
  double otherwise_behind_wall =
      evidence_table::kOtherwiseBehindWall;  ///< ... where a wall is between the stations
  double alike = evidence_table::kAlike;     ///< that is furnished alike as well
};

/// Those of a registration. Where a user says that no room, flat or storey of the building was built like
/// another, such words are wrong in one case of twenty, as a start's may be, and bare rooms stay in doubt.
LookAlikeOptions look_alike_options(bool nothing_repeats);

/// What things say of three explanations of two scans whose walls agree: one place; a look-alike place that
/// is furnished otherwise; one that is furnished alike. docs/judge.md has the model,
/// evidence_table::kFurniture its numbers. Without observations there is no evidence for or against any.
LookAlikeEvidence weigh_look_alike(const SeenClutter& clutter, const LookAlikeOptions& options = {});

/// Of things against a look-alike place, whatever share of a building's is its own: more of one that is
/// exactly as drawn (of this probability). Over several pairs the nats of each share add up.
double otherwise_nats(const LookAlikeEvidence& evidence, double as_drawn = evidence_table::kAsDrawn);
double alike_nats(const LookAlikeEvidence& evidence, double as_drawn = evidence_table::kAsDrawn);

/// How large a share of a room's things is where it was: the probability of each of so many shares.
inline constexpr std::size_t kStayedLevels = 24;
using StayedBelief = std::array<double, kStayedLevels>;

/// Of any room (kFurniture.stayed).
const StayedBelief& stayed_beforehand();
/// Of what was seen, under each of these shares, the logarithm of the likelihood.
StayedBelief logs_of_stayed(const LookAlikeEvidence& evidence);
/// By how much likelier what was seen is with this belief than with that of any room, nats.
double nats_of_stayed(const LookAlikeEvidence& evidence, const StayedBelief& stayed);

/// Nats of things against a look-alike place that is furnished otherwise. `as_drawn`: probability that the
/// building is exactly as drawn. `stayed_nats`: nats_of_stayed, where more is known than of any room.
double against_otherwise(const LookAlikeEvidence& evidence, double as_drawn, double stayed_nats = 0.0);
/// Nats of things against one that is furnished alike. How many of its things match is not known: it is given
/// the better of two shares. So things that agree never exclude it, only faces that agree better than hands
/// put them.
double against_alike(const LookAlikeEvidence& evidence, double as_drawn, double stayed_nats = 0.0);

/// Odds of a look-alike place of either kind, by things and walls. The walls say, too, whether the building
/// is exactly as drawn.
double odds_of(const LookAlikeEvidence& evidence);
/// The probability that the scans show two look-alike places and not one, by Bayes' rule.
double probability_of(const LookAlikeEvidence& evidence);

/// Why a look-alike place cannot be excluded: the end of a sentence for a user.
std::string look_alike_words(const SeenClutter& clutter, double probability);

}  // namespace limen
