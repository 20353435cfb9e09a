// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/judge/twin_odds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "limen/base/error.h"
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
std::array<Node, 10> shares_of(const ShareBelief& belief) {
  std::array<Node, 10> nodes;
  std::array<double, 10> logs{};
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

/// Of a lognormal distribution (Gauss-Hermite).
std::array<Node, 3> scales_of(double median, double spread) {
  const double far = std::exp(std::numbers::sqrt3 * spread);
  return {{{median / far, std::log(1.0 / 6.0)},
           {median, std::log(2.0 / 3.0)},
           {median * far, std::log(1.0 / 6.0)}}};
}

constexpr double kStray = 0.1;  // share of the faces of a thing of the building that are of something else

/// Log-likelihood of faces. Not all that is the building's is known as such: a step, a fitting, a reveal at
/// an angle. In a look-alike place a share of the things is the building's, and agrees with all its faces.
class FaceLikelihood {
 public:
  explicit FaceLikelihood(const IndividualMatter& seen) : seen_(seen) {
    for (const FaceMiss& face : seen.faces) {
      const double exact = normal_density(face.offset_m, face.sigma_m);
      as_built_[face.thing] += face.share * std::log((1.0 - kStray) * exact + kStray * kAnywhere);
    }
  }

  /// `densities`: of each face, where none is the building's.
  [[nodiscard]] double of(const std::vector<double>& densities) const {
    double sum = 0.0;
    for (std::size_t k = 0; k < densities.size(); ++k) sum += seen_.faces[k].share * std::log(densities[k]);
    return sum;
  }

  /// The same where a share of the things is the building's.
  [[nodiscard]] double with_built_in(const std::vector<double>& densities) const {
    std::map<int, double> as_put;
    for (std::size_t k = 0; k < densities.size(); ++k)
      as_put[seen_.faces[k].thing] += seen_.faces[k].share * std::log(densities[k]);
    double sum = 0.0;
    for (const auto& [thing, log] : as_put)
      sum += log_sum_exp(
          {std::log1p(-kFurniture.built_in) + log, std::log(kFurniture.built_in) + as_built_.at(thing)});
    return sum;
  }

 private:
  const IndividualMatter& seen_;
  std::map<int, double> as_built_;  ///< of each thing, if it is the building's
};

/// Two explanations in which a share of the things is where it was, or was put: one room, or one that is
/// furnished alike.
struct Arrangement {
  bool look_alike = false;
  std::array<Node, 3>
      scales;  ///< of the faces in place: factors of their deviations; of a look-alike, metres on top
  double pushed = 0.0;  ///< share of the other faces that lies near its place
};

const Arrangement& one_room() {
  static const Arrangement room{false, scales_of(kFurniture.measured, kFurniture.measured_spread),
                                kFurniture.pushed};
  return room;
}

const Arrangement& furnished_alike() {
  static const Arrangement alike{true, scales_of(kFurniture.put_m, kFurniture.put_spread), 0.0};
  return alike;
}

/// The share of things in place, as that of one room, is one for what agrees and for faces; it and the scale
/// are integrated out.
double log_likelihood(const IndividualMatter& seen, const Arrangement& arrangement) {
  static const std::array<Node, 10> shares = shares_of(kFurniture.stayed);
  const double agreeing = seen.matter.agreeing();
  const FaceLikelihood faces(seen);
  std::vector<double> elsewhere;
  for (const FaceMiss& face : seen.faces) {
    const double pushed = normal_density(face.offset_m, std::hypot(kFurniture.pushed_m, face.sigma_m));
    elsewhere.push_back(arrangement.pushed * pushed + (1.0 - arrangement.pushed) * kAnywhere);
  }
  std::vector<double> in_place(seen.faces.size());
  std::vector<double> densities(seen.faces.size());
  std::vector<double> logs;
  for (const Node& scale : arrangement.scales) {
    for (std::size_t k = 0; k < seen.faces.size(); ++k) {
      const FaceMiss& face = seen.faces[k];
      in_place[k] = normal_density(face.offset_m, arrangement.look_alike ? std::hypot(scale.at, face.sigma_m)
                                                                         : scale.at * face.sigma_m);
    }
    for (const Node& share : shares) {
      for (std::size_t k = 0; k < densities.size(); ++k)
        densities[k] = share.at * in_place[k] + (1.0 - share.at) * elsewhere[k];
      logs.push_back(scale.log_weight + share.log_weight + agreeing * std::log(share.at) +
                     (seen.matter.count - agreeing) * std::log1p(-share.at) +
                     (arrangement.look_alike ? faces.with_built_in(densities) : faces.of(densities)));
    }
  }
  return log_sum_exp(logs);
}

/// Where the things are another room's, they agree by chance.
double log_likelihood_of_chance(const IndividualMatter& seen) {
  const ShareBelief chance{std::clamp(seen.chance + kFurniture.more_than_chance, 0.01, 0.7),
                           kFurniture.chance_strength};
  const double agreeing = seen.matter.agreeing();
  std::vector<double> densities;
  for (const FaceMiss& face : seen.faces) {
    const double met = normal_density(face.offset_m, std::hypot(kFurniture.met_m, face.sigma_m));
    densities.push_back(kFurniture.met * met + (1.0 - kFurniture.met) * kAnywhere);
  }
  return log_beta_binomial(agreeing, seen.matter.count - agreeing, chance) +
         FaceLikelihood(seen).with_built_in(densities);
}

constexpr double kFew = 3.0;          // observations
constexpr double kMostlyOther = 0.6;  // share agreeing below which the things are others

}  // namespace

void TwinOptions::check() const {
  const std::pair<const char*, double> odds[] = {
      {"otherwise", otherwise}, {"otherwise_apart", otherwise_apart}, {"alike", alike}};
  for (const auto& [name, value] : odds) {
    if (!(value >= 0)) throw_bad_option(name, value, "0 or more");
  }
}

TwinOptions twin_options(bool nothing_repeats) {
  constexpr double kWordsWrong = 0.05;
  TwinOptions options;
  if (!nothing_repeats) return options;
  for (double* believed : {&options.otherwise, &options.otherwise_apart, &options.alike})
    *believed *= kWordsWrong;
  return options;
}

TwinEvidence weigh_twin(const IndividualMatter& individual, const TwinOptions& options) {
  options.check();
  TwinEvidence evidence;
  evidence.alike = options.alike;
  evidence.otherwise = individual.apart ? options.otherwise_apart : options.otherwise;
  const double same = log_likelihood(individual, one_room());
  evidence.otherwise_nats = same - log_likelihood_of_chance(individual);
  evidence.alike_nats = same - log_likelihood(individual, furnished_alike());
  evidence.built = individual.built;
  evidence.things = individual.matter.count;
  evidence.agreeing = individual.matter.agreeing();
  return evidence;
}

double against_otherwise(const TwinEvidence& evidence) {
  return evidence.otherwise_nats + built_nats(evidence.built);
}

double against_alike(const TwinEvidence& evidence) {
  const double other = evidence.things - evidence.agreeing;
  const double own = log_beta_binomial(evidence.agreeing, other, kFurniture.stayed) -
                     log_beta_binomial(evidence.agreeing, other, kFurniture.alike);
  return evidence.alike_nats + std::min(0.0, own) + built_nats(evidence.built);
}

double odds_of(const TwinEvidence& evidence) {
  return evidence.otherwise * std::exp(-against_otherwise(evidence)) +
         evidence.alike * std::exp(-against_alike(evidence));
}

double probability_of(const TwinEvidence& evidence) {
  const double odds = odds_of(evidence);
  return std::isfinite(odds) ? odds / (1.0 + odds) : 1.0;
}

std::string twin_words(const IndividualMatter& individual, double probability) {
  const Observations& matter = individual.matter;
  if (matter.count < kFew)
    return fmt::format("a look-alike room cannot be excluded ({}): both scans see hardly anything but walls",
                       percent_words(probability));
  if (matter.share < kMostlyOther)
    return fmt::format(
        "a look-alike room fits better ({}): the walls agree, but only {:.0f} % of the objects in the room "
        "do",
        percent_words(probability), 100.0 * matter.share);
  return fmt::format(
      "a room built and furnished alike cannot be excluded ({}): {:.0f} % of the objects in the room agree, "
      "but too few to the millimetre",
      percent_words(probability), 100.0 * matter.share);
}

}  // namespace limen
