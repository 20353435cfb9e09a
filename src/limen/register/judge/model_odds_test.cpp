// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/judge/model_odds.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace limen {
namespace {

WallBalance walls(double asked, double share) {
  return {asked, asked * share};
}

TEST(ModelOdds, GrowWithTheShareAndWithWhatWasSeen) {
  double before = -1e9;
  for (const double share : {0.0, 0.2, 0.4, 0.6, 0.8, 1.0}) {
    const double odds = log_odds_of_model({walls(12, share)}).front();
    EXPECT_GT(odds, before);
    before = odds;
  }
  EXPECT_GT(log_odds_of_model({walls(20, 0.95)}).front(), log_odds_of_model({walls(5, 0.95)}).front());
  EXPECT_LT(log_odds_of_model({walls(20, 0.2)}).front(), log_odds_of_model({walls(5, 0.2)}).front());
}

TEST(ModelOdds, NothingSeenTellsNothing) {
  EXPECT_NEAR(log_odds_of_model({walls(0, 0)}).front(), 0.0, 1e-12);
}

TEST(ModelOdds, AreLowerWhereChanceReachesMore) {
  const std::vector<WallBalance> poor(10, walls(14, 0.15));
  const std::vector<WallBalance> rich(10, walls(14, 0.55));
  std::vector<WallBalance> among_poor = poor;
  std::vector<WallBalance> among_rich = rich;
  among_poor.push_back(walls(14, 0.7));
  among_rich.push_back(walls(14, 0.7));
  EXPECT_GT(log_odds_of_model(among_poor).back(), log_odds_of_model(among_rich).back() + 1.0);
}

TEST(ModelOdds, EqualRoomsAreNotTakenForChance) {
  const double alone = log_odds_of_model({walls(14, 0.95)}).front();
  const std::vector<double> many = log_odds_of_model(std::vector<WallBalance>(30, walls(14, 0.95)));
  EXPECT_GT(many.front(), 0.8 * alone);
}

TEST(ModelOdds, DoNotDependOnTheOrderOfPoses) {
  std::vector<WallBalance> poses = {walls(14, 0.9), walls(12, 0.3), walls(13, 0.5)};
  std::vector<double> odds = log_odds_of_model(poses);
  std::reverse(poses.begin(), poses.end());
  std::vector<double> turned = log_odds_of_model(poses);
  std::reverse(turned.begin(), turned.end());
  for (std::size_t i = 0; i < odds.size(); ++i) EXPECT_NEAR(odds[i], turned[i], 1e-9);
}

}  // namespace
}  // namespace limen
