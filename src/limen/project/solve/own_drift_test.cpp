// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/solve/own_drift.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "support/synthetic_street.h"
#include <gtest/gtest.h>

namespace limen {
namespace {

double learned_m(double drift_m, double believed_m) {
  double sum = 0.0;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SyntheticStreet street(drift_m, seed);
    std::vector<ProjectNode> nodes{street.station(0.0), street.pass()};
    nodes[1].digest.drift_m = believed_m;
    learn_own_drift(nodes);
    EXPECT_FALSE(nodes[0].drift.has_value());
    if (!nodes[1].drift) return 0.0;
    // Nothing turned: turns are believed in less than before.
    const double before_m = std::max(drift_m, believed_m);
    EXPECT_LT(nodes[1].drift->turn_rate_rad2_per_m, 6.0 * before_m * before_m / 100.0 / 900.0);
    sum += nodes[1].strays_m() / 3.0;
  }
  return sum;
}

TEST(OwnDrift, APassSaysLouderThanItsPlanesHowFarItStrays) {
  for (const double drift_m : {0.008, 0.02, 0.05}) {
    for (const double believed_m : {0.012, 0.03}) {
      const double found = learned_m(drift_m, believed_m);
      const double before = std::abs(std::log(believed_m / drift_m));
      EXPECT_LT(std::abs(std::log(found / drift_m)), 0.3 + 0.5 * before)
          << drift_m << " believed " << believed_m << " found " << found;
    }
  }
}

TEST(OwnDrift, APassWithoutTimesKeepsWhatItsPlanesShow) {
  SyntheticStreet street(0.02, 1);
  std::vector<ProjectNode> nodes{street.pass()};
  nodes[0].digest.drift_m = 0.013;
  nodes[0].digest.track.way = {};
  learn_own_drift(nodes);
  EXPECT_EQ(nodes[0].strays_m(), 0.013);
}

}  // namespace
}  // namespace limen
