// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/judge/look_alike_odds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <fmt/format.h>

#include "limen/base/text.h"
#include "limen/register/judge/as_built.h"

namespace limen {
namespace {

using evidence_table::kFurniture;

constexpr double kAnywhere = 1.0 / (2.0 * kNearFaceM);  // density of offsets that nothing ties

/// Normal density of an offset, cut off at +-kNearFaceM.
double normal_density(double offset_m, double sigma_m) {
  const double z = offset_m / sigma_m;
  const double inside = std::erf(kNearFaceM / (sigma_m * std::numbers::sqrt2));
  return std::exp(-0.5 * z * z) / (sigma_m * std::sqrt(2.0 * std::numbers::pi) * std::max(inside, 1e-9));
}

/// A value of an unknown that is integrated out, and the logarithm of its weight.
struct Node {
  double at = 0.0;
  double log_weight = 0.0;
};

/// Midpoints of equal steps, weighed by the density of a beta distribution.
template <std::size_t N>
std::array<Node, N> shares_of(const ShareBelief& belief) {
  std::array<Node, N> nodes;
  std::array<double, N> logs{};
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const double q = (static_cast<double>(k) + 0.5) / static_cast<double>(nodes.size());
    logs[k] = (belief.mean * belief.strength - 1.0) * std::log(q) +
              ((1.0 - belief.mean) * belief.strength - 1.0) * std::log1p(-q);
    nodes[k].at = q;
  }
  const double sum = log_sum_exp(logs);
  for (std::size_t k = 0; k < nodes.size(); ++k) nodes[k].log_weight = logs[k] - sum;
  return nodes;
}

/// Values of a lognormal distribution (Gauss-Hermite) ...
std::array<double, 3> scales_of(double median, double spread) {
  const double far = std::exp(std::numbers::sqrt3 * spread);
  return {median / far, median, median * far};
}
/// ... and the logarithms of their weights.
const std::array<double, 3> kLogScale = {std::log(1.0 / 6.0), std::log(2.0 / 3.0), std::log(1.0 / 6.0)};

/// Logarithms of the densities of what was seen of each thing, under one assumption.
using OfThings = std::vector<double>;

OfThings of_surface(const SeenClutter& seen, const ShareBelief& agreeing) {
  OfThings logs;
  for (const ThingSeen& thing : seen.things)
    logs.push_back(log_beta_binomial(thing.agreeing, thing.count - thing.agreeing, agreeing));
  return logs;
}

/// Adds the faces of each thing. `near`: of so large a share, the rest lies anywhere; `sigma_m`: of a face
/// near its place.
template <typename Sigma>
void add_faces(const SeenClutter& seen, double near, const Sigma& sigma_m, OfThings& logs) {
  for (const FaceMiss& face : seen.faces)
    logs[face.thing] +=
        face.share * std::log(near * normal_density(face.offset_m, sigma_m(face)) + (1.0 - near) * kAnywhere);
}

/// If they are where they were, or were put: one for each scale of the deviations of faces.
template <typename Sigma>
std::array<OfThings, 3> in_place(const SeenClutter& seen, double median, double spread,
                                 const Sigma& sigma_m) {
  const OfThings surface = of_surface(seen, kFurniture.in_place);
  std::array<OfThings, 3> kept;
  const std::array<double, 3> scales = scales_of(median, spread);
  for (std::size_t k = 0; k < kept.size(); ++k) {
    kept[k] = surface;
    add_faces(
        seen, kFurniture.in_place.mean, [&](const FaceMiss& face) { return sigma_m(face, scales[k]); },
        kept[k]);
  }
  return kept;
}

/// As they were measured: the scale is how well the deviations are known.
std::array<OfThings, 3> kept_in_place(const SeenClutter& seen) {
  return in_place(seen, kFurniture.measured, kFurniture.measured_spread,
                  [](const FaceMiss& face, double scale) { return scale * face.sigma_m; });
}

/// As people put them: the scale, metres, comes on top.
std::array<OfThings, 3> put_in_place(const SeenClutter& seen) {
  return in_place(seen, kFurniture.put_m, kFurniture.put_spread,
                  [](const FaceMiss& face, double scale) { return std::hypot(scale, face.sigma_m); });
}

/// If the things were moved or replaced: surface agrees by chance, and a share `near` of the faces lies
/// within about `near_m` of another face.
OfThings elsewhere(const SeenClutter& seen, double near, double near_m) {
  const ShareBelief chance{std::clamp(seen.chance + kFurniture.more_than_chance, 0.01, 0.7),
                           kFurniture.chance_strength};
  OfThings logs = of_surface(seen, chance);
  add_faces(
      seen, near, [&](const FaceMiss& face) { return std::hypot(near_m, face.sigma_m); }, logs);
  return logs;
}

/// Shares of a building's things that are its own (a step, a fitting), evenly by the logarithm of their odds.
const std::array<double, kBuiltInLevels>& built_in_shares() {
  static const std::array<double, kBuiltInLevels> shares = [] {
    constexpr double kFirstLogOdds = -6.0;
    constexpr double kStep = 1.5;
    std::array<double, kBuiltInLevels> levels{};
    for (std::size_t j = 0; j < levels.size(); ++j)
      levels[j] = 1.0 / (1.0 + std::exp(-kFirstLogOdds - kStep * static_cast<double>(j)));
    return levels;
  }();
  return shares;
}

/// Of each of these shares the logarithm of its probability.
NatsOfThings log_built_in(const ShareBelief& belief) {
  NatsOfThings logs{};
  for (std::size_t j = 0; j < logs.size(); ++j)
    logs[j] = belief.strength * (belief.mean * std::log(built_in_shares()[j]) +
                                 (1.0 - belief.mean) * std::log1p(-built_in_shares()[j]));
  const double sum = log_sum_exp(logs);
  for (double& log : logs) log -= sum;
  return logs;
}

/// The same of a building that is exactly as drawn with this probability.
NatsOfThings log_built_in(double as_drawn) {
  static const NatsOfThings built = log_built_in(kFurniture.built_in);
  static const NatsOfThings drawn = log_built_in(evidence_table::kBuiltInAsDrawn);
  NatsOfThings logs{};
  for (std::size_t j = 0; j < logs.size(); ++j)
    logs[j] = log_sum_exp({std::log1p(-as_drawn) + built[j], std::log(as_drawn) + drawn[j]});
  return logs;
}

/// Of all things, for each share that is the building's: those are as in `fixed`, the others as in `loose`.
NatsOfThings sums_of(const OfThings& fixed, const OfThings& loose) {
  NatsOfThings sums{};
  for (std::size_t j = 0; j < sums.size(); ++j) {
    const double log_fixed = std::log(built_in_shares()[j]);
    const double log_loose = std::log1p(-built_in_shares()[j]);
    for (std::size_t g = 0; g < loose.size(); ++g)
      sums[j] += log_sum_exp({log_fixed + fixed[g], log_loose + loose[g]});
  }
  return sums;
}

/// For each share the logarithm of a sum over weighted cases.
class LogMixture {
 public:
  void add(double log_weight, const NatsOfThings& logs) {
    for (std::size_t j = 0; j < kBuiltInLevels; ++j) cases_[j].push_back(log_weight + logs[j]);
  }
  [[nodiscard]] NatsOfThings sum() const {
    NatsOfThings sums{};
    for (std::size_t j = 0; j < kBuiltInLevels; ++j) sums[j] = log_sum_exp(cases_[j]);
    return sums;
  }

 private:
  std::array<std::vector<double>, kBuiltInLevels> cases_;
};

/// Of the other things an unknown share is as in `kept`; it and the scale are integrated out.
NatsOfThings log_likelihood(const std::array<OfThings, 3>& fixed, const std::array<OfThings, 3>& kept,
                            const OfThings& elsewhere, const ShareBelief& share) {
  LogMixture mixture;
  OfThings loose(elsewhere.size());
  for (const Node& node : shares_of<10>(share)) {
    const double log_kept = std::log(node.at);
    const double log_elsewhere = std::log1p(-node.at);
    for (std::size_t k = 0; k < kept.size(); ++k) {
      for (std::size_t g = 0; g < loose.size(); ++g)
        loose[g] = log_sum_exp({log_kept + kept[k][g], log_elsewhere + elsewhere[g]});
      mixture.add(kLogScale[k] + node.log_weight, sums_of(fixed[k], loose));
    }
  }
  return mixture.sum();
}

/// Where all but the building's are another room's.
NatsOfThings log_likelihood_of_others(const std::array<OfThings, 3>& fixed, const OfThings& elsewhere) {
  LogMixture mixture;
  for (std::size_t k = 0; k < fixed.size(); ++k) mixture.add(kLogScale[k], sums_of(fixed[k], elsewhere));
  return mixture.sum();
}

/// Of things, whatever share of them is the building's. `against`: nats against each share.
double log_likelihood_of(const NatsOfThings& against, double as_drawn) {
  NatsOfThings logs = log_built_in(as_drawn);
  for (std::size_t j = 0; j < logs.size(); ++j) logs[j] -= against[j];
  return log_sum_exp(logs);
}

/// Of one place, whatever the share, against another explanation.
NatsOfThings nats_against(double same, const NatsOfThings& other) {
  NatsOfThings nats{};
  for (std::size_t j = 0; j < nats.size(); ++j) nats[j] = same - other[j];
  return nats;
}

constexpr double kFew = 3.0;          // observations
constexpr double kMostlyOther = 0.6;  // share agreeing below which the things are others

}  // namespace

LookAlikeOptions look_alike_options(bool nothing_repeats) {
  constexpr double kWordsWrong = 0.05;
  LookAlikeOptions options;
  if (!nothing_repeats) return options;
  for (double* believed : {&options.otherwise, &options.otherwise_behind_wall, &options.alike})
    *believed *= kWordsWrong;
  return options;
}

LookAlikeEvidence weigh_look_alike(const SeenClutter& clutter, const LookAlikeOptions& options) {
  LookAlikeEvidence evidence;
  evidence.alike = options.alike;
  evidence.otherwise = clutter.behind_wall ? options.otherwise_behind_wall : options.otherwise;
  evidence.built = clutter.built;
  for (const ThingSeen& thing : clutter.things) {
    const double seen = std::min(1.0, thing.count);
    evidence.things += seen;
    if (thing.count > 0.0) evidence.agreeing += seen * thing.agreeing / thing.count;
  }
  const std::array<OfThings, 3> kept = kept_in_place(clutter);
  const std::array<OfThings, 3> put = put_in_place(clutter);
  const OfThings pushed = elsewhere(clutter, kFurniture.pushed, kFurniture.pushed_m);
  const OfThings others = elsewhere(clutter, kFurniture.met, kFurniture.met_m);
  const NatsOfThings here = log_likelihood(kept, kept, pushed, kFurniture.stayed);
  const double same = log_likelihood_of(nats_against(0.0, here), evidence_table::kAsDrawn);
  evidence.share_nats = nats_against(same, here);
  evidence.otherwise_nats = nats_against(same, log_likelihood_of_others(kept, others));
  evidence.alike_nats = nats_against(same, log_likelihood(kept, put, others, kFurniture.stayed));

  return evidence;
}

double otherwise_nats(const LookAlikeEvidence& evidence, double as_drawn) {
  return log_likelihood_of(evidence.share_nats, as_drawn) -
         log_likelihood_of(evidence.otherwise_nats, as_drawn);
}

double alike_nats(const LookAlikeEvidence& evidence, double as_drawn) {
  return log_likelihood_of(evidence.share_nats, as_drawn) - log_likelihood_of(evidence.alike_nats, as_drawn);
}

const StayedBelief& stayed_beforehand() {
  static const StayedBelief belief = [] {
    StayedBelief shares{};
    const auto nodes = shares_of<kStayedLevels>(kFurniture.stayed);
    for (std::size_t j = 0; j < shares.size(); ++j) shares[j] = std::exp(nodes[j].log_weight);
    return shares;
  }();
  return belief;
}

StayedBelief logs_of_stayed(const LookAlikeEvidence& evidence) {
  StayedBelief logs{};
  for (std::size_t j = 0; j < logs.size(); ++j) {
    const double share = (static_cast<double>(j) + 0.5) / static_cast<double>(logs.size());
    logs[j] =
        evidence.agreeing * std::log(share) + (evidence.things - evidence.agreeing) * std::log1p(-share);
  }
  return logs;
}

double nats_of_stayed(const LookAlikeEvidence& evidence, const StayedBelief& stayed) {
  const StayedBelief logs = logs_of_stayed(evidence);
  StayedBelief now{};
  StayedBelief before{};
  for (std::size_t j = 0; j < logs.size(); ++j) {
    now[j] = logs[j] + std::log(stayed[j]);
    before[j] = logs[j] + std::log(stayed_beforehand()[j]);
  }
  return log_sum_exp(now) - log_sum_exp(before);
}

double against_otherwise(const LookAlikeEvidence& evidence, double as_drawn, double stayed_nats) {
  return otherwise_nats(evidence, as_drawn) + stayed_nats;
}

double against_alike(const LookAlikeEvidence& evidence, double as_drawn, double stayed_nats) {
  const double other = evidence.things - evidence.agreeing;
  const double own = log_beta_binomial(evidence.agreeing, other, kFurniture.stayed) + stayed_nats -
                     log_beta_binomial(evidence.agreeing, other, kFurniture.alike);
  return alike_nats(evidence, as_drawn) + std::min(0.0, own);
}

double odds_of(const LookAlikeEvidence& evidence) {
  const double as_drawn = probability_as_drawn(as_drawn_nats(evidence.built));
  return std::exp(-built_nats(evidence.built)) *
         (evidence.otherwise * std::exp(-against_otherwise(evidence, as_drawn)) +
          evidence.alike * std::exp(-against_alike(evidence, as_drawn)));
}

double probability_of(const LookAlikeEvidence& evidence) {
  const double odds = odds_of(evidence);
  return std::isfinite(odds) ? odds / (1.0 + odds) : 1.0;
}

std::string look_alike_words(const SeenClutter& clutter, double probability) {
  const Observations& pieces = clutter.pieces;
  if (pieces.count < kFew)
    return fmt::format("a look-alike room cannot be excluded ({}): both scans see hardly anything but walls",
                       percent_words(probability));
  if (pieces.share < kMostlyOther)
    return fmt::format(
        "a look-alike room fits better ({}): the walls agree, but only {:.0f} % of the objects in the room "
        "do",
        percent_words(probability), 100.0 * pieces.share);
  return fmt::format(
      "a room built and furnished alike cannot be excluded ({}): {:.0f} % of the objects in the room agree, "
      "but too few to the millimetre",
      percent_words(probability), 100.0 * pieces.share);
}

}  // namespace limen
