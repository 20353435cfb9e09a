// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/judge/model_odds.h"

#include <algorithm>
#include <cmath>

#include "limen/base/error.h"

namespace limen {
namespace {

constexpr double kLeastChance = 0.2;  // what chance reaches is not presumed to be less, or more, than this
constexpr double kMostChance = 0.6;

/// Logarithm of the probability of these observations, the share integrated out.
double log_evidence(const WallBalance& walls, const ShareBelief& belief) {
  return log_beta_binomial(walls.explained, std::max(0.0, walls.asked - walls.explained), belief);
}

}  // namespace

void ModelOddsOptions::check() const {
  of_model.check("of_model");
  by_chance.check("by_chance");
  if (!(known_poses > 0)) throw_bad_option("known_poses", known_poses, "more than 0");
}

std::vector<double> log_odds_of_model(const std::vector<WallBalance>& poses,
                                      const ModelOddsOptions& options) {
  options.check();
  const auto log_odds = [&](const WallBalance& walls, const ShareBelief& chance) {
    return log_evidence(walls, options.of_model) - log_evidence(walls, chance);
  };
  double shares = options.known_poses * options.by_chance.mean;
  double count = options.known_poses;
  for (const WallBalance& walls : poses) {
    // One look, not several: of many equal rooms each would make the others seem chance.
    const double wrong = 1.0 / (1.0 + std::exp(log_odds(walls, options.by_chance)));
    shares += wrong * walls.share();
    count += wrong;
  }
  ShareBelief chance = options.by_chance;
  chance.mean = std::clamp(shares / count, kLeastChance, kMostChance);
  std::vector<double> odds;
  for (const WallBalance& walls : poses) odds.push_back(log_odds(walls, chance));
  return odds;
}

}  // namespace limen
