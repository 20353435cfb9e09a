// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/pair_evidence.h"

#include <algorithm>
#include <cmath>

namespace limen {
namespace {

/// Evidence that leaves a probability of `probability`, of whichever kind of look-alike place.
LookAlikeEvidence look_alike_evidence_of(double probability) {
  constexpr double kMostNats = 50.0;
  LookAlikeEvidence evidence;
  const double nats =
      probability > 0.0 ? std::min(kMostNats, std::log((1.0 - probability) / probability)) : kMostNats;
  evidence.otherwise_nats.fill(nats);
  evidence.alike_nats.fill(nats);
  return evidence;
}

/// A wrong pose agrees with the others of a configuration with this probability: poses that differ by less
/// than a tolerance, among all that a building offers (metres and right angles).
const double kCoincidence = 1e-3;
constexpr double kLeastProbability = 1e-9;
constexpr double kGivenWrong = 1e-6;  // of a pose that a file or a survey gives

double bounded(double nats) {
  return std::clamp(nats, -kMostPairNats, kMostPairNats);
}

void add_to(NatsOfThings& sum, double weight, const NatsOfThings& nats) {
  for (std::size_t j = 0; j < sum.size(); ++j) sum[j] += weight * bounded(nats[j]);
}

double against(double chance_nats, double odds_of_look_alike) {
  return -std::log(std::exp(-chance_nats) + odds_of_look_alike);
}

}  // namespace

double PairEvidence::odds_of_look_alike() const {
  if (!asks_look_alike) return 0.0;
  return asks_things() ? odds_of(look_alikes)
                       : (look_alikes.otherwise + look_alikes.alike) * std::exp(-behind_windows_nats());
}

double PairEvidence::behind_windows_nats() const {
  return bounded(look_alikes.otherwise_nats.front()) +
         evidence_table::kAgreeingBehind * std::max(0.0, chance_nats);
}

void LookAlikeSum::add(const PairEvidence& evidence, double of_things, double of_surface) {
  if (evidence.asks_things()) {
    add_things(evidence.look_alikes, of_things);
    add_walls(evidence.look_alikes.built, of_surface);
  } else {
    const double by_surface =
        evidence.asks_look_alike ? evidence.behind_windows_nats() : evidence.chance_nats;
    for (NatsOfThings* sum : {&sum_.otherwise_nats, &sum_.alike_nats})
      for (double& nats : *sum) nats += (evidence.stated ? 1.0 : of_surface) * by_surface;
  }
}

void LookAlikeSum::add_things(const LookAlikeEvidence& look_alikes, double of_things) {
  add_to(sum_.otherwise_nats, of_things, look_alikes.otherwise_nats);
  add_to(sum_.alike_nats, of_things, look_alikes.alike_nats);
  add_to(sum_.share_nats, of_things, look_alikes.share_nats);
  sum_.things += of_things * look_alikes.things;
  sum_.agreeing += of_things * look_alikes.agreeing;
}

void LookAlikeSum::add_walls(const BuiltEvidence& walls, double of_surface) {
  built_nats_ += std::clamp(built_nats(walls, belief_, of_surface), -kMostPairNats,
                            std::min(1.0, of_surface) * kMostPairNats);
}

double PairEvidence::alone() const {
  return std::max(-kMostPairNats, against(chance_nats, odds_of_look_alike()));
}

double PairEvidence::in_loop() const {
  return std::max(-kMostPairNats, against(chance_nats + coincidence_nats, odds_of_look_alike()));
}

PairEvidence evidence_of(const GraphLink& link, std::size_t pose) {
  PairEvidence evidence;
  if (link.trust == LinkTrust::given) {
    evidence.chance_nats = -std::log(std::max(link.chance, kGivenWrong));
    evidence.coincidence_nats = -std::log(kCoincidence);
    evidence.stated = true;
    return evidence;
  }
  // The pair is trusted no further than that; its poses exclude one another as surely as it says.
  const auto probability = [&](std::size_t k) {
    return std::max(link.poses[k].probability, kLeastProbability);
  };
  double best = 0.0;
  for (std::size_t k = 0; k < link.poses.size(); ++k) best = std::max(best, probability(k));
  // If the best pose lays a place on a look-alike one, no other pose has anything in common but by chance.
  const double nothing = link.chance + (static_cast<int>(pose) == link.best ? 0.0 : link.look_alike);
  const double wrong = std::max(nothing, kLeastProbability);
  evidence.chance_nats = std::max(
      -kMostPairNats, std::min(kMostPairNats, std::log(best / wrong)) + std::log(probability(pose) / best));
  // Of several poses one agrees by chance so much sooner.
  evidence.coincidence_nats = -std::log(kCoincidence * static_cast<double>(link.poses.size()));
  evidence.stated = link.accepted;
  evidence.asks_look_alike = link.asks_look_alike();
  if (evidence.asks_look_alike)
    evidence.look_alikes = link.poses[pose].look_alike.value_or(look_alike_evidence_of(link.look_alike));
  return evidence;
}

}  // namespace limen
