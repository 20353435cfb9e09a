// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "limen/model/twin_evidence.h"
#include "limen/register/judge/evidence_table.h"
#include "limen/register/judge/individual_matter.h"
#include "limen/register/judge/share_belief.h"

namespace limen {

struct TwinOptions {
  double otherwise = evidence_table::kOtherwise;             ///< odds beforehand of a look-alike place ...
  double otherwise_apart = evidence_table::kOtherwiseApart;  ///< ... where a wall is between the stations
  double alike = evidence_table::kAlike;                     ///< ... and of one furnished alike as well
  /// Share of a room's things that stayed between the two scans: mostly nearly all of them; in some pairs
  /// the room was used in between, and any share is as good as another.
  ShareBelief kept{0.9, 7.0};
  double lived_in = 0.2;  ///< share of such pairs
  ShareBelief kept_lived_in{0.55, 4.0};
  /// Rooms furnished alike have the same furniture, and people's own things in and on it; in some nothing but
  /// what is alike.
  ShareBelief put_alike{0.62, 6.0};
  double nothing_own = 0.5;        ///< share of such pairs: their things agree as those of one room
  double more_than_chance = 0.05;  ///< rooms are furnished along walls and round tables: added to chance
  double chance_strength = 20.0;   ///< how well chance is known, in observations

  void check() const;
};

/// The same where a user says that no room, flat or storey of the building was built like another: such words
/// are wrong in one case of twenty, as a start's may be (start_prior.h), and bare rooms stay in doubt.
TwinOptions where_nothing_repeats(TwinOptions options);

/// What things say of three explanations of two scans whose walls fit: one room; a twin furnished otherwise;
/// a twin furnished alike. Each says with which share individual matter and faces agree; the share itself is
/// integrated out (beta-binomial). Without observations there is no evidence for or against any.
TwinEvidence weigh_twin(const IndividualMatter& individual, const TwinOptions& options = {});

/// The probability that the scans show two rooms built alike and not one, by Bayes' rule.
double probability_of_twin(const IndividualMatter& individual, const TwinOptions& options = {});

/// What a user should know of a pair whose twin cannot be excluded: one sentence's end.
std::string twin_words(const IndividualMatter& individual, double probability);

}  // namespace limen
