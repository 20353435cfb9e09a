// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/judge/twin_odds.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "limen/base/error.h"

namespace limen {
namespace {

double log_beta(double a, double b) {
  return std::lgamma(a) + std::lgamma(b) - std::lgamma(a + b);
}

/// log of the mean of q^k (1 - q)^(n - k) over the belief about the share q; k of n agree.
double log_likelihood(const Observations& seen, const ShareBelief& belief) {
  const double a = belief.mean * belief.strength;
  const double b = (1.0 - belief.mean) * belief.strength;
  const double agreeing = seen.agreeing();
  return log_beta(a + agreeing, b + seen.count - agreeing) - log_beta(a, b);
}

void check_share(const char* name, double value) {
  if (!(value > 0 && value < 1)) throw_bad_option(name, value, "within (0, 1)");
}

void check_belief(const char* name, const ShareBelief& belief) {
  check_share(name, belief.mean);
  if (!(belief.strength > 0)) throw_bad_option(name, belief.strength, "more than 0");
}

constexpr double kFew = 3.0;          // observations
constexpr double kMostlyOther = 0.6;  // share agreeing below which the things are others

}  // namespace

void TwinOptions::check() const {
  check_share("prior", prior);
  check_share("alike_share", alike_share);
  if (!(apart_share > 0 && apart_share <= 1)) throw_bad_option("apart_share", apart_share, "within (0, 1]");
  check_belief("kept", kept);
  check_belief("kept_faces", kept_faces);
  check_belief("alike_faces", alike_faces);
  if (!(more_than_chance >= 0)) throw_bad_option("more_than_chance", more_than_chance, "0 or more");
  if (!(chance_strength > 0)) throw_bad_option("chance_strength", chance_strength, "more than 0");
}

double probability_of_twin(const IndividualMatter& individual, const TwinOptions& options) {
  options.check();
  const ShareBelief chance{std::clamp(individual.chance + options.more_than_chance, 0.01, 0.7),
                           options.chance_strength};
  const double same = std::log(1.0 - options.prior) + log_likelihood(individual.matter, options.kept) +
                      log_likelihood(individual.faces, options.kept_faces);
  const double alike_share = options.alike_share * (individual.apart ? options.apart_share : 1.0);
  const double other = std::log(options.prior * (1.0 - alike_share)) +
                       log_likelihood(individual.matter, chance) +
                       log_likelihood(individual.faces, options.alike_faces);
  const double alike = std::log(options.prior * alike_share) +
                       log_likelihood(individual.matter, options.kept) +
                       log_likelihood(individual.faces, options.alike_faces);
  const double most = std::max({same, other, alike});
  const double twin = std::exp(other - most) + std::exp(alike - most);
  return twin / (twin + std::exp(same - most));
}

std::string twin_words(const IndividualMatter& individual, double probability) {
  const Observations& matter = individual.matter;
  if (matter.count < kFew)
    return fmt::format(
        "another room built alike would fit as well ({:.1f} %): hardly anything but walls was seen "
        "by both scans",
        100.0 * probability);
  if (matter.share < kMostlyOther)
    return fmt::format(
        "another room built alike fits better ({:.1f} %): the walls agree, but only {:.0f} % of what "
        "stands in the room does",
        100.0 * probability, 100.0 * matter.share);
  return fmt::format(
      "another room built and furnished alike would fit as well ({:.1f} %): {:.0f} % of what stands "
      "in the room agrees, too little of it to the millimetre",
      100.0 * probability, 100.0 * matter.share);
}

}  // namespace limen
