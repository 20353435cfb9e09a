// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/judge/start_prior.h"

#include <cmath>

#include <gtest/gtest.h>

#include "limen/base/angles.h"
#include "limen/base/error.h"

namespace limen {
namespace {

constexpr double kMost = 9.5;
const Vector3d kAt(3.0, -2.0, 1.0);

StartPrior belief(double sigma_m, double sigma_deg) {
  StartPrior start;
  start.target_from_source = {rotation_exp({0, 0, 1.0}), {100.0, 50.0, 2.0}};
  start.sigma_m = sigma_m;
  start.sigma_rad = radians(sigma_deg);
  return start;
}

Rigid3 moved(const Rigid3& pose, double by_m, double turn_deg = 0.0) {
  Rigid3 result = pose;
  result.rotation = rotation_exp({0, 0, radians(turn_deg)}) * pose.rotation;
  result.translation += pose * kAt - result * kAt + Vector3d(by_m, 0.0, 0.0);
  return result;
}

TEST(StartPrior, MissIsStatedAtThePointAsked) {
  const StartPrior start = belief(2.0, 5.0);
  const StartAgreement miss = miss_of_start(start, moved(start.target_from_source, 1.0, 10.0), kAt);
  EXPECT_NEAR(miss.shift_m, 1.0, 1e-9);
  EXPECT_NEAR(degrees(miss.turn_rad), 10.0, 1e-9);
  EXPECT_NEAR(miss.sigmas, 2.0, 1e-9);
}

TEST(StartPrior, NearPosesGainAndFarOnesLoseAtMostWhatIsNotTrusted) {
  const StartPrior start = belief(2.0, 5.0);
  const auto prior = [&](double by_m) {
    return log_prior_of_start(start, moved(start.target_from_source, by_m), kAt, true, kMost);
  };
  EXPECT_GT(prior(0.0), 3.0);
  EXPECT_GT(prior(0.0), prior(3.0));
  EXPECT_GT(prior(3.0), prior(8.0));
  EXPECT_NEAR(prior(500.0), std::log(0.05), 1e-9);
}

TEST(StartPrior, IsNoEvidenceThatScansShareAnything) {
  const StartPrior sharp = belief(0.001, 0.01);
  EXPECT_EQ(log_prior_of_start(sharp, sharp.target_from_source, kAt, false, kMost), kMost);
}

TEST(StartPrior, AWideBeliefSaysNothing) {
  const StartPrior wide = belief(1e4, 1e4);
  EXPECT_NEAR(log_prior_of_start(wide, wide.target_from_source, kAt, true, kMost), 0.0, 1e-6);
}

TEST(StartPrior, LookAlikesAreRuledOutByWhatIsKnownToTheMetreOnly) {
  const auto gain = [](double sigma_m) {
    const StartPrior start = belief(sigma_m, 5.0);
    return log_prior_of_start(start, start.target_from_source, kAt, true, kMost) -
           log_prior_elsewhere(start, start.target_from_source, kAt, 2.5);
  };
  EXPECT_GT(gain(0.3), gain(2.0));
  EXPECT_GT(gain(2.0), gain(10.0));
  EXPECT_NEAR(log_prior_elsewhere(belief(0.1, 5.0), belief(0.1, 5.0).target_from_source, kAt, 2.5),
              std::log(0.05), 1e-6);
}

TEST(StartPrior, ASharpBeliefInTheWrongRoomDoesNotExcludeALookAlike) {
  const StartPrior sharp = belief(0.05, 0.3);
  const Rigid3& pose = sharp.target_from_source;
  const double gain =
      odds_of_look_alike_beside_start(sharp, pose, kAt, log_prior_of_start(sharp, pose, kAt, true, kMost));
  EXPECT_NEAR(gain, (1.0 - sharp.trust) / sharp.trust, 1e-6);
  // Nothing believed of the place: nothing changes.
  EXPECT_NEAR(odds_of_look_alike_beside_start(belief(1e4, 1e4), pose, kAt, 0.0), 1.0, 1e-6);
}

TEST(StartPrior, OptionsAreChecked) {
  EXPECT_THROW(belief(0.0, 5.0).check(), Error);
  EXPECT_THROW(belief(1.0, -5.0).check(), Error);
  EXPECT_NO_THROW(belief(1.0, 5.0).check());
}

}  // namespace
}  // namespace limen
