// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "limen/register/judge/individual_matter.h"

namespace limen {

/// A share that is not known exactly, as the mean and the strength (in observations) of a beta distribution.
struct ShareBelief {
  double mean = 0.5;
  double strength = 2.0;
};

struct TwinOptions {
  double prior = 0.15;         ///< of the pairs whose walls fit, those of two rooms built alike
  double alike_share = 0.05;   ///< of those, furnished alike as well, to a few centimetres
  double apart_share = 0.1;    ///< of those again, where the stations stand in two rooms: both must be alike
  ShareBelief kept{0.9, 7.0};  ///< share of a room's things that stayed between the two scans
  /// Of the faces that stayed those that noise explains; the rest was pushed a little.
  ShareBelief kept_faces{0.93, 8.0};
  double more_than_chance = 0.1;  ///< rooms are furnished along walls and round tables: added to chance
  double chance_strength = 10.0;  ///< how well chance is known, in observations
  /// Furniture put up alike by hand, to 2 or 3 cm: a face within 6 cm of its like lies within 8 mm in a
  /// quarter of the cases or less.
  ShareBelief alike_faces{0.22, 8.0};

  void check() const;
};

/// The probability that the scans show two rooms built alike and not one, given that their walls fit.
/// Bayes' rule over three explanations: one room; a twin furnished otherwise; a twin furnished alike. Each
/// says with which share individual matter and faces agree; the share itself is integrated out
/// (beta-binomial). Without observations it is the prior.
double probability_of_twin(const IndividualMatter& individual, const TwinOptions& options = {});

/// What a user should know of a pair whose twin cannot be excluded: one sentence's end.
std::string twin_words(const IndividualMatter& individual, double probability);

}  // namespace limen
