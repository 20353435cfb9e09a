// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/look_alike_rate.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "limen/register/judge/evidence_table.h"
#include "limen/register/judge/look_alike_odds.h"

namespace limen {
namespace {

constexpr double kBelievedOdds = evidence_table::kOtherwise + evidence_table::kAlike;
constexpr double kMean = kBelievedOdds / (1.0 + kBelievedOdds);
constexpr double kAlikePart = kMean * evidence_table::kRateStrength;  // of the beta distribution
constexpr double kOtherPart = (1.0 - kMean) * evidence_table::kRateStrength;
constexpr std::size_t kShares = 49;  // evenly by the logarithm of their odds
constexpr std::size_t kHalf = kShares / 2;
constexpr double kFirstLogOdds = -12.0;
constexpr double kStep = 0.5;

double odds_at(std::size_t k) {
  return std::exp(kFirstLogOdds + kStep * static_cast<double>(k));
}

double share(std::size_t k) {
  return odds_at(k) / (1.0 + odds_at(k));
}

/// The tails beyond the first and the last share are theirs.
std::vector<double> density_beforehand() {
  std::vector<double> logs(kShares);
  for (std::size_t k = 0; k < kShares; ++k)
    logs[k] = kAlikePart * std::log(share(k)) + kOtherPart * std::log1p(-share(k));
  logs.front() += std::log1p(1.0 / (kAlikePart * kStep));
  logs.back() += std::log1p(1.0 / (kOtherPart * kStep));
  return logs;
}

/// The likelihood of each share, by what a link says of one place, of a look-alike one, and of chance. What
/// is believed of the link beforehand, a user's word too, says nothing of the building.
std::vector<double> logs_of(const LookAlikeEvidence& look_alikes, double here, double chance) {
  std::vector<double> logs(kShares);
  const double beforehand = look_alikes.otherwise + look_alikes.alike;
  const double look_alike = odds_of(look_alikes);
  for (std::size_t k = 0; k < kShares; ++k) {
    const double rate = odds_at(k) / kBelievedOdds;
    logs[k] = std::log(here + rate * look_alike + chance) - std::log1p(rate * beforehand);
  }
  return logs;
}

void add(double weight, const std::vector<double>& more, std::vector<double>& logs) {
  for (std::size_t k = 0; k < kShares; ++k) logs[k] += weight * more[k];
}

}  // namespace

std::vector<UnusedLink> unused_links(const PoseGraph& graph, const LinkMatcher& matcher,
                                     const Configuration& configuration) {
  std::vector<UnusedLink> unused;
  for (std::size_t k = 0; k < graph.links.size(); ++k) {
    const GraphLink& link = graph.links[k];
    if (configuration.pose[k] >= 0 || link.trust != LinkTrust::measured) continue;
    const PairEvidence& evidence = matcher.evidence(k, 0);
    if (evidence.asks_things() && evidence.chance_nats > 0.0)
      unused.push_back({link.source, link.target, evidence, configuration.joins(link)});
  }
  return unused;
}

LookAlikeRate::LookAlikeRate(const Viewpoints& viewpoints, int nodes, const std::vector<PlacedPair>& pairs,
                             const std::vector<UnusedLink>& unused)
    : others_(density_beforehand()), links_(static_cast<std::size_t>(nodes)), agreeing_(links_.size(), 0.0) {
  std::vector<double> all(links_.size(), 0.0);
  for (const PlacedPair& pair : pairs) {
    if (pair.link < 0 || !pair.evidence.asks_things() || viewpoints.is_same(pair.source, pair.target))
      continue;
    links_[static_cast<std::size_t>(pair.source)].push_back({pair.target, votes_.size()});
    links_[static_cast<std::size_t>(pair.target)].push_back({pair.source, votes_.size()});
    votes_.push_back(logs_of(pair.evidence.look_alikes, 1.0, 0.0));
  }
  for (std::size_t n = 0; n < links_.size(); ++n) all[n] = static_cast<double>(links_[n].size());
  for (const UnusedLink& link : unused) {
    all[static_cast<std::size_t>(link.source)] += 1.0;
    all[static_cast<std::size_t>(link.target)] += 1.0;
  }
  std::vector<bool> linked;
  for (const double links : all) linked.push_back(links > 0.0);
  const std::vector<double> weights = viewpoints.weights(linked);
  for (std::size_t n = 0; n < links_.size(); ++n)
    agreeing_[n] = weights[n] * static_cast<double>(links_[n].size()) / std::max(1.0, all[n]);
  for (const UnusedLink& link : unused) {
    const auto source = static_cast<std::size_t>(link.source);
    const auto target = static_cast<std::size_t>(link.target);
    const double weight = weights[source] / all[source] + weights[target] / all[target];
    add(weight,
        logs_of(link.evidence.look_alikes, link.contradicted ? 0.0 : 1.0,
                std::exp(-link.evidence.chance_nats)),
        others_);
  }
}

double LookAlikeRate::factor(const std::vector<bool>& side) const {
  std::vector<double> logs = others_;
  for (std::size_t n = 0; n < links_.size(); ++n) {
    const std::vector<double>* clearest = nullptr;
    for (const Link& link : links_[n]) {
      const std::vector<double>& vote = votes_[link.vote];
      if (side[n] == side[static_cast<std::size_t>(link.other)] &&
          (clearest == nullptr || vote[kHalf] < (*clearest)[kHalf]))
        clearest = &vote;
    }
    if (clearest != nullptr) add(agreeing_[n], *clearest, logs);
  }
  const double most = *std::max_element(logs.begin(), logs.end());
  double look_alike = 0.0;
  double all = 0.0;
  for (std::size_t k = 0; k < kShares; ++k) {
    const double density = std::exp(logs[k] - most);
    look_alike += share(k) * density;
    all += density;
  }
  return look_alike / (all - look_alike) / kBelievedOdds;
}

}  // namespace limen
