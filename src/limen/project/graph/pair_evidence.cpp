// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/pair_evidence.h"

#include <algorithm>
#include <cmath>

namespace limen {
namespace {

/// A wrong pose agrees with the others of a configuration with this probability: poses that differ by less
/// than a tolerance, among all that a building offers (metres and right angles).
const double kCoincidence = 1e-3;
constexpr double kLeastProbability = 1e-9;
constexpr double kGivenWrong = 1e-6;  // of a pose that a file or a survey gives

double against(double chance_nats, double odds_of_twin) {
  return -std::log(std::exp(-chance_nats) + odds_of_twin);
}

}  // namespace

double PairEvidence::against_twin(double TwinEvidence::*nats) const {
  if (!looks_for_twins) return chance_nats;
  return std::clamp(twins.*nats + twins.built_nats, -kMostPairNats, kMostPairNats);
}

double PairEvidence::alone() const {
  return std::max(-kMostPairNats, against(chance_nats, odds_of_twin()));
}

double PairEvidence::in_loop() const {
  return std::max(-kMostPairNats, against(chance_nats + coincidence_nats, odds_of_twin()));
}

PairEvidence evidence_of(const GraphLink& link, std::size_t pose) {
  PairEvidence evidence;
  if (link.trust == LinkTrust::given) {
    evidence.chance_nats = -std::log(std::max(link.chance, kGivenWrong));
    evidence.coincidence_nats = -std::log(kCoincidence);
    return evidence;
  }
  const double right = std::max(link.poses[pose].probability, kLeastProbability);
  const double wrong = std::max(link.chance, kLeastProbability);
  evidence.chance_nats = std::clamp(std::log(right / wrong), -kMostPairNats, kMostPairNats);
  // Of several poses one agrees by chance so much sooner.
  evidence.coincidence_nats = -std::log(kCoincidence * static_cast<double>(link.poses.size()));
  evidence.looks_for_twins = link.asks_for_twins();
  if (!evidence.looks_for_twins) return evidence;
  evidence.twins = link.against_twins();
  // Look-alikes were asked about under the pair's best pose. Against another pose they are likelier by as
  // much as that pose is less likely than the best.
  const double best =
      std::max(link.poses[static_cast<std::size_t>(link.best)].probability, kLeastProbability);
  evidence.twins.otherwise_nats += std::log(right / best);
  evidence.twins.alike_nats += std::log(right / best);
  return evidence;
}

}  // namespace limen
