// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/judge/model_odds.h"

#include <algorithm>
#include <cmath>

#include "limen/register/judge/share_belief.h"

namespace limen {
namespace {

// Share of the walls that are the model's where the pose is right: the rest was moved, is missing, or is
// furniture as high as the room. Of 24 furnished and 24 unfurnished simulated rooms: 0.64 to 1.
constexpr ShareBelief kOfModel{0.86, 8.0};
// Share that the best of all wrong poses explains by chance, before any is seen. Of 40 scans in models of
// other buildings: 0 to 0.5.
constexpr ShareBelief kByChance{0.35, 12.0};
constexpr double kKnownPoses = 4.0;   // what is presumed of chance counts as much as so many poses
constexpr double kLeastChance = 0.2;  // what chance reaches is not presumed to be less, or more, than this
constexpr double kMostChance = 0.6;

/// Logarithm of the probability of these observations, the share integrated out.
double log_evidence(const WallBalance& walls, const ShareBelief& belief) {
  return log_beta_binomial(walls.explained, std::max(0.0, walls.asked - walls.explained), belief);
}

}  // namespace

std::vector<double> log_odds_of_model(const std::vector<WallBalance>& poses) {
  const auto log_odds = [&](const WallBalance& walls, const ShareBelief& chance) {
    return log_evidence(walls, kOfModel) - log_evidence(walls, chance);
  };
  double shares = kKnownPoses * kByChance.mean;
  double count = kKnownPoses;
  for (const WallBalance& walls : poses) {
    // One look, not several: of many equal rooms each would make the others seem chance.
    const double wrong = 1.0 / (1.0 + std::exp(log_odds(walls, kByChance)));
    shares += wrong * walls.share();
    count += wrong;
  }
  ShareBelief chance = kByChance;
  chance.mean = std::clamp(shares / count, kLeastChance, kMostChance);
  std::vector<double> odds;
  for (const WallBalance& walls : poses) odds.push_back(log_odds(walls, chance));
  return odds;
}

}  // namespace limen
