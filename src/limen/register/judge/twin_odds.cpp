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

namespace limen {
namespace {

double log_likelihood(const Observations& seen, const ShareBelief& belief) {
  const double agreeing = seen.agreeing();
  return log_beta_binomial(agreeing, seen.count - agreeing, belief);
}

/// Of pairs of two kinds, a share of the second.
double log_likelihood(const Observations& seen, const ShareBelief& first, const ShareBelief& second,
                      double share_of_second) {
  return log_sum_exp({std::log(1.0 - share_of_second) + log_likelihood(seen, first),
                      std::log(share_of_second) + log_likelihood(seen, second)});
}

/// Normal density of an offset, cut off at +-kNearFaceM.
double normal_density(double offset_m, double sigma_m) {
  const double z = offset_m / sigma_m;
  const double inside = std::erf(kNearFaceM / (sigma_m * std::numbers::sqrt2));
  return std::exp(-0.5 * z * z) / (sigma_m * std::sqrt(2.0 * std::numbers::pi) * std::max(inside, 1e-9));
}

constexpr double kFlushM = 0.003;  // things of one make are as deep as one another, and walls are flat

/// One way in which the offsets of one explanation may be spread: a share of the faces is where it was, a
/// share was pushed, and the rest has nothing to do with one another.
struct OffsetScene {
  double weight = 1.0;    ///< how often it is
  double placed = 0.0;    ///< share of the first ...
  double measured = 1.0;  ///< ... of which measuring leaves so many times what is thought
  double pushed = 0.0;    ///< share of the second ...
  double pushed_m = 0.0;  ///< ... spread by so much on top
  double flush = 0.0;     ///< share of fronts that are of one make and stand flush with a wall
  double designed = 0.0;  ///< share of the things that are the building's after all, with all their faces

  [[nodiscard]] double density(double offset_m, double sigma_m, bool front) const {
    double sum = (1.0 - placed - pushed) / (2.0 * kNearFaceM);
    if (placed > 0.0) sum += placed * normal_density(offset_m, measured * sigma_m);
    if (pushed > 0.0) sum += pushed * normal_density(offset_m, std::hypot(pushed_m, sigma_m));
    if (front && flush > 0.0)
      sum = (1.0 - flush) * sum + flush * normal_density(offset_m, std::hypot(kFlushM, sigma_m));
    return sum;
  }
};

/// One room: what stayed is where it was; of what is nearby some was pushed, or is another thing. What
/// measuring leaves may be overrated (smooth fronts, averaged over many points) or underrated: roughness,
/// round shapes, the pose.
std::vector<OffsetScene> one_room() {
  constexpr std::array<std::pair<double, double>, 4> kMeasured = {
      {{0.3, 0.35}, {0.3, 1.0}, {0.3, 2.0}, {0.1, 3.5}}};
  // As it was; or used in between. Scans of one day and of two, about as many of each (scripts/fit_judge).
  constexpr std::array<OffsetScene, 8> kUses = {{{.weight = 0.30, .placed = 0.95},
                                                 {.weight = 0.10, .placed = 0.75},
                                                 {0.30, 0.6, 1.0, 0.35, 0.01},
                                                 {0.10, 0.4, 1.0, 0.4, 0.01},
                                                 {0.05, 0.3, 1.0, 0.2, 0.01},
                                                 {0.05, 0.6, 1.0, 0.35, 0.02},
                                                 {0.05, 0.4, 1.0, 0.4, 0.02},
                                                 {0.05, 0.3, 1.0, 0.2, 0.02}}};
  std::vector<OffsetScene> scenes;
  for (const auto& [weight, measured] : kMeasured) {
    for (OffsetScene scene : kUses) {
      scene.weight *= weight;
      scene.measured = measured;
      scenes.push_back(scene);
    }
  }
  return scenes;
}

/// Not all that is the building's is known as such (a reveal at an angle, a fitting): in three twins of ten
/// some of what is compared is that, and is where it was designed.
constexpr double kDesignedScenes = 0.3;
constexpr double kDesigned = 0.12;  // share of such things
constexpr double kStrayFace = 0.1;  // of their faces those that are others' after all

std::vector<OffsetScene> with_designed(const std::vector<OffsetScene>& scenes) {
  std::vector<OffsetScene> both;
  for (const OffsetScene& scene : scenes) {
    both.push_back(scene);
    both.back().weight *= 1.0 - kDesignedScenes;
    both.push_back(scene);
    both.back().weight *= kDesignedScenes;
    both.back().designed = kDesigned;
  }
  return both;
}

/// Fronts of things of one make that stand flush with walls are equally far from them, whoever put them
/// there: most are, or few (`often`: how often the former).
std::vector<OffsetScene> with_fronts(const std::vector<OffsetScene>& scenes, double often) {
  std::vector<OffsetScene> both;
  for (const OffsetScene& scene : scenes) {
    for (const auto& [weight, flush] : {std::pair{often, 0.9}, std::pair{1.0 - often, 0.3}}) {
      both.push_back(scene);
      both.back().weight *= weight;
      both.back().flush = flush;
    }
  }
  return both;
}

/// Put up alike: by hand to some centimetres, where there are fittings or marks to under one.
std::vector<OffsetScene> furnished_alike() {
  std::vector<OffsetScene> scenes;
  constexpr std::array<std::pair<double, double>, 4> kPlacing = {
      {{0.15, 0.008}, {0.30, 0.015}, {0.35, 0.025}, {0.20, 0.040}}};
  for (const auto& [weight, placing_m] : kPlacing) scenes.push_back({weight, 0.0, 1.0, 0.95, placing_m});
  return with_designed(scenes);
}

/// Another room's things meet by chance, but for those of one make that stand against walls alike.
std::vector<OffsetScene> furnished_otherwise() {
  return with_designed({{0.6, 0.0, 1.0, 0.1, 0.010}, {0.4, 0.0, 1.0, 0.4, 0.010}});
}

/// What the faces of one thing say, put where it is by hand or as the building was drawn.
struct ThingLogs {
  double put = 0.0;
  double designed = 0.0;
};

/// log of the likelihood of the offsets, tempered to the number of independent ones. How far a thing was put
/// from its place one way says nothing of the other; but that it is the building's holds for all its sides.
double log_likelihood(const std::vector<FaceMiss>& faces, const std::vector<OffsetScene>& scenes) {
  std::vector<double> logs;
  logs.reserve(scenes.size());
  for (const OffsetScene& scene : scenes) {
    std::map<int, ThingLogs> things;
    for (const FaceMiss& face : faces) {
      ThingLogs& thing = things[face.thing];
      const double put = scene.density(face.offset_m, face.sigma_m, face.front);
      thing.put += face.share * std::log(put);
      if (scene.designed > 0.0)
        thing.designed +=
            face.share *
            std::log((1.0 - kStrayFace) * normal_density(face.offset_m, face.sigma_m) + kStrayFace * put);
    }
    double sum = std::log(scene.weight);
    for (const auto& [number, thing] : things)
      sum += scene.designed > 0.0 ? log_sum_exp({std::log(1.0 - scene.designed) + thing.put,
                                                 std::log(scene.designed) + thing.designed})
                                  : thing.put;
    logs.push_back(sum);
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
  const std::pair<const char*, double> odds[] = {
      {"otherwise", otherwise}, {"otherwise_apart", otherwise_apart}, {"alike", alike}};
  for (const auto& [name, value] : odds) {
    if (!(value >= 0)) throw_bad_option(name, value, "0 or more");
  }
  kept.check("kept");
  check_share("lived_in", lived_in);
  kept_lived_in.check("kept_lived_in");
  put_alike.check("put_alike");
  check_share("nothing_own", nothing_own);
  if (!(more_than_chance >= 0)) throw_bad_option("more_than_chance", more_than_chance, "0 or more");
  if (!(chance_strength > 0)) throw_bad_option("chance_strength", chance_strength, "more than 0");
}

TwinOptions where_nothing_repeats(TwinOptions options) {
  constexpr double kWordsWrong = 0.05;
  for (double* believed : {&options.otherwise, &options.otherwise_apart, &options.alike})
    *believed *= kWordsWrong;
  return options;
}

TwinEvidence weigh_twin(const IndividualMatter& individual, const TwinOptions& options) {
  options.check();
  const ShareBelief chance{std::clamp(individual.chance + options.more_than_chance, 0.01, 0.7),
                           options.chance_strength};
  const double stayed =
      log_likelihood(individual.matter, options.kept, options.kept_lived_in, options.lived_in);
  const double as_put =
      log_likelihood(individual.matter, options.put_alike, options.kept, options.nothing_own);
  const double same = log_likelihood(individual.faces, one_room());
  // Of a whole room sides are seen as well as fronts, and by chance one is elsewhere; through a door few
  // things are, mostly their fronts.
  const std::vector<OffsetScene> alike =
      individual.apart ? with_fronts(furnished_alike(), 0.5) : furnished_alike();
  const std::vector<OffsetScene> otherwise =
      individual.apart ? with_fronts(furnished_otherwise(), 0.1) : furnished_otherwise();
  TwinEvidence evidence;
  evidence.alike = options.alike;
  evidence.otherwise = individual.apart ? options.otherwise_apart : options.otherwise;
  evidence.otherwise_nats =
      stayed - log_likelihood(individual.matter, chance) + same - log_likelihood(individual.faces, otherwise);
  // Things that agree to centimetres speak against no twin furnished alike: how much of its rooms' things is
  // their own is a property of a building, and would count anew in each of its pairs.
  evidence.alike_nats = std::min(0.0, stayed - as_put) + same - log_likelihood(individual.faces, alike);
  // Scans of some sensors are bent within themselves: they say nothing of how a building was built.
  evidence.built_nats = log_sum_exp(
      {std::log(1.0 - evidence_table::kBent) + individual.built_nats, std::log(evidence_table::kBent)});
  return evidence;
}

double probability_of_twin(const IndividualMatter& individual, const TwinOptions& options) {
  return weigh_twin(individual, options).probability();
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
