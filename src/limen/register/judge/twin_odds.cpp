// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/judge/twin_odds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "limen/base/error.h"

namespace limen {
namespace {

double log_likelihood(const Observations& seen, const ShareBelief& belief) {
  const double agreeing = seen.agreeing();
  return log_beta_binomial(agreeing, seen.count - agreeing, belief);
}

/// Density of an offset within +-kNearFaceM for a normal deviation `sigma`, mixed with `stray` of the even
/// one.
double offset_density(double offset_m, double sigma_m, double stray) {
  const double z = offset_m / sigma_m;
  const double inside = std::erf(kNearFaceM / (sigma_m * std::numbers::sqrt2));
  const double normal =
      std::exp(-0.5 * z * z) / (sigma_m * std::sqrt(2.0 * std::numbers::pi) * std::max(inside, 1e-9));
  return (1.0 - stray) * normal + stray / (2.0 * kNearFaceM);
}

/// One way in which the offsets of one explanation may be spread, and how often it is.
struct OffsetScene {
  double weight;
  double sigma_m;         ///< on top of what measuring leaves
  double stray;           ///< share that has nothing to do with one another
  double measured = 1.0;  ///< measuring leaves so many times what is thought
};

// One room: what stayed is where it was; of what is nearby some was pushed, or is another thing. What
// measuring leaves may be underrated: roughness, round shapes, the pose.
constexpr std::array<OffsetScene, 9> kOneRoom = {{{0.55 * 0.45, 0.0, 0.05},
                                                  {0.33 * 0.45, 0.0, 0.25},
                                                  {0.12 * 0.45, 0.0, 0.55},
                                                  {0.55 * 0.45, 0.0, 0.05, 2.0},
                                                  {0.33 * 0.45, 0.0, 0.25, 2.0},
                                                  {0.12 * 0.45, 0.0, 0.55, 2.0},
                                                  {0.55 * 0.10, 0.0, 0.05, 3.5},
                                                  {0.33 * 0.10, 0.0, 0.25, 3.5},
                                                  {0.12 * 0.10, 0.0, 0.55, 3.5}}};
// Put up alike: by hand to some centimetres, where there are fittings or marks to under one.
constexpr std::array<OffsetScene, 4> kFurnishedAlike = {
    {{0.15, 0.008, 0.05}, {0.30, 0.015, 0.05}, {0.35, 0.025, 0.05}, {0.20, 0.040, 0.05}}};
// Another room's things meet by chance, but for those of one make that stand against walls alike.
constexpr std::array<OffsetScene, 2> kFurnishedOtherwise = {{{0.6, 0.010, 0.9}, {0.4, 0.010, 0.6}}};

/// log of the likelihood of the offsets, tempered to the number of independent ones.
template <std::size_t N>
double log_likelihood(const FaceOffsets& faces, const std::array<OffsetScene, N>& scenes) {
  std::array<double, N> logs = {};
  for (std::size_t k = 0; k < N; ++k) {
    const OffsetScene& scene = scenes[k];
    double sum = 0.0;
    for (std::size_t i = 0; i < faces.offsets_m.size(); ++i) {
      const double sigma = std::hypot(scene.sigma_m, scene.measured * faces.sigmas_m[i]);
      sum += faces.shares[i] * std::log(offset_density(faces.offsets_m[i], sigma, scene.stray));
    }
    logs[k] = std::log(scenes[k].weight) + sum;
  }
  return log_sum_exp(logs);
}

void check_share(const char* name, double value) {
  if (!(value > 0 && value < 1)) throw_bad_option(name, value, "within (0, 1)");
}

constexpr double kFew = 3.0;          // observations
constexpr double kMostlyOther = 0.6;  // share agreeing below which the things are others

}  // namespace

void TwinOptions::check() const {
  check_share("prior", prior);
  check_share("prior_apart", prior_apart);
  check_share("alike_share", alike_share);
  if (!(apart_share > 0 && apart_share <= 1)) throw_bad_option("apart_share", apart_share, "within (0, 1]");
  kept.check("kept");
  check_share("lived_in", lived_in);
  kept_lived_in.check("kept_lived_in");
  if (!(more_than_chance >= 0)) throw_bad_option("more_than_chance", more_than_chance, "0 or more");
  if (!(chance_strength > 0)) throw_bad_option("chance_strength", chance_strength, "more than 0");
}

double probability_of_twin(const IndividualMatter& individual, const TwinOptions& options) {
  options.check();
  const ShareBelief chance{std::clamp(individual.chance + options.more_than_chance, 0.01, 0.7),
                           options.chance_strength};
  const double stayed =
      log_sum_exp({std::log(1.0 - options.lived_in) + log_likelihood(individual.matter, options.kept),
                   std::log(options.lived_in) + log_likelihood(individual.matter, options.kept_lived_in)});
  const double prior = individual.apart ? options.prior_apart : options.prior;
  const double same = std::log(1.0 - prior) + stayed + log_likelihood(individual.faces, kOneRoom);
  const double alike_share = options.alike_share * (individual.apart ? options.apart_share : 1.0);
  const double other = std::log(prior * (1.0 - alike_share)) + log_likelihood(individual.matter, chance) +
                       log_likelihood(individual.faces, kFurnishedOtherwise);
  const double alike =
      std::log(prior * alike_share) + stayed + log_likelihood(individual.faces, kFurnishedAlike);
  return std::exp(log_sum_exp({other, alike}) - log_sum_exp({same, other, alike}));
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
