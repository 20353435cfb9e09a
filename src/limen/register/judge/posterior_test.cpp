// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/judge/posterior.h"

#include <numeric>

#include <gtest/gtest.h>

#include "limen/base/error.h"

namespace limen {
namespace {

double sum(const Posterior& all) {
  return std::accumulate(all.poses.begin(), all.poses.end(), 0.0) + all.others.nothing_shared +
         all.others.twin + all.others.unlisted_pose;
}

TEST(Posterior, EverythingSumsToOne) {
  for (const double value : {0.0, 3.0, 8.0, 40.0}) {
    EXPECT_NEAR(sum(posterior({value, {0.5, 3.0, 9.0}, 0.2})), 1.0, 1e-12) << value;
  }
}

TEST(Posterior, APoseSetAsideIsAPartOfTheTwin) {
  PosteriorEvidence evidence{20.0, {3.0}, 0.02};
  const Posterior before = posterior(evidence);
  evidence.odds_of_twins = {4.0, 0.5};
  const Posterior all = posterior(evidence);
  EXPECT_NEAR(sum(all), 1.0, 1e-12);
  ASSERT_EQ(all.poses.size(), 4U);
  EXPECT_EQ(all.poses[0], before.poses[0]);
  EXPECT_LT(all.poses[2], all.poses[3]);
  EXPECT_NEAR(all.others.twin + all.poses[2] + all.poses[3], before.others.twin, 1e-12);
}

TEST(Posterior, MuchCommonSurfaceLeavesTheBestAlone) {
  const Posterior all = posterior({30.0, {12.0}, 0.0});
  EXPECT_GT(all.poses[0], 0.999);
  EXPECT_LT(all.others.nothing_shared, 1e-6);
}

TEST(Posterior, HardlyAnyCommonSurfaceMeansNothingShared) {
  EXPECT_GT(posterior({2.0, {0.1}, 0.0}).others.nothing_shared, 0.9);
}

TEST(Posterior, ThingsAskedOneByOneTakeThePlaceOfTheirSurface) {
  // 7 m^2, of which things say one: 5 nats of chance are left, and 12 speak for the pose instead of 2.
  PosteriorEvidence evidence{7.0, {}, 0.0};
  const double before = posterior(evidence).others.nothing_shared;
  evidence.things_m2 = 1.0;
  evidence.things_nats = PosteriorOptions{}.nats_per_m2;
  EXPECT_NEAR(posterior(evidence).others.nothing_shared, before, 1e-12);
  evidence.things_nats = 12.0;
  EXPECT_LT(posterior(evidence).others.nothing_shared, 1e-4 * before);
  evidence.things_nats = -3.0;
  EXPECT_GT(posterior(evidence).others.nothing_shared, before);
}

TEST(Posterior, ChanceIsAskedOfThePoseThatLeads) {
  // 40 m^2 that a pose of 4 m^2 contradicts: neither is probable.
  PosteriorEvidence evidence{40.0, {-20.0}, 0.0};
  evidence.values_m2 = {4.0};
  const Posterior all = posterior(evidence);
  EXPECT_NEAR(sum(all), 1.0, 1e-12);
  EXPECT_GT(all.others.nothing_shared, 0.5);
  EXPECT_LT(all.poses[1], 0.5);
  // One of as much value is as sure as the best would be.
  evidence.values_m2 = {39.0};
  EXPECT_GT(posterior(evidence).poses[1], 0.999);
  // What does not lead changes nothing.
  evidence.leads_m2 = {3.0};
  evidence.values_m2 = {4.0};
  EXPECT_EQ(posterior(evidence).poses, posterior({40.0, {3.0}, 0.0}).poses);
}

TEST(Posterior, AStreetShowsMuchThatRepeats) {
  PosteriorEvidence evidence{9.5, {}, 0.0};
  EXPECT_LT(posterior(evidence).others.nothing_shared, 1e-3);
  evidence.through_wall = true;
  EXPECT_GT(posterior(evidence).others.nothing_shared, 0.4);
  evidence.best_value_m2 = 30.0;
  EXPECT_LT(posterior(evidence).others.nothing_shared, 1e-6);
}

TEST(Posterior, WhatChanceReachesInAModelIsLearnedThere) {
  double before = 1.0;
  for (const double odds : {-3.0, 0.0, 3.0, 9.0}) {
    const double nothing = posterior({30.0, {}, 0.0, odds}).others.nothing_shared;
    EXPECT_LT(nothing, before);
    before = nothing;
  }
  const OtherExplanations poor = posterior({30.0, {}, 0.0, -3.0}).others;
  EXPECT_GT(poor.nothing_shared + poor.unlisted_pose, 0.9);
  EXPECT_LT(before, 1e-3);
}

TEST(Posterior, PosesThatCannotBeToldApartShare) {
  const Posterior all = posterior({30.0, {0.0}, 0.0});
  EXPECT_NEAR(all.poses[0], 0.5, 1e-6);
  EXPECT_EQ(all.poses[0], all.poses[1]);
}

TEST(Posterior, ATwinTakesItsShare) {
  const Posterior all = posterior({30.0, {}, 0.25});
  EXPECT_NEAR(all.others.twin, 0.25, 1e-6);
  EXPECT_NEAR(all.poses[0], 0.75, 1e-6);
}

TEST(Posterior, BoundsAreNamed) {
  PosteriorOptions options;
  options.prior_shared = 1.0;
  EXPECT_THROW(posterior({}, options), Error);
}

TEST(PosteriorVerdict, WhatMayBeChanceIsNotRegistered) {
  Verdict verdict;
  verdict.outcome = Outcome::registered;
  EXPECT_EQ(with_posterior(verdict, posterior({30.0, {12.0}, 0.0}), 1e-3).outcome, Outcome::registered);
  const Verdict little = with_posterior(verdict, posterior({7.0, {12.0}, 0.0}), 1e-3);
  EXPECT_EQ(little.outcome, Outcome::ambiguous);
  EXPECT_NE(little.reason.find("chance"), std::string::npos) << little.reason;
  const Verdict two = with_posterior(verdict, posterior({30.0, {2.0}, 0.0}), 1e-3);
  EXPECT_EQ(two.outcome, Outcome::ambiguous);
  EXPECT_NE(two.reason.find("one of them"), std::string::npos) << two.reason;
  EXPECT_EQ(with_posterior(verdict, posterior({7.0, {12.0}, 0.0}), 0.4).outcome, Outcome::registered);
  verdict.outcome = Outcome::under_constrained;
  EXPECT_EQ(with_posterior(verdict, posterior({7.0, {12.0}, 0.0}), 1e-3).outcome, Outcome::under_constrained);
}

}  // namespace
}  // namespace limen
