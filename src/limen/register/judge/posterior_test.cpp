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

/// Probabilities of the best pose, another one, a twin and chance.
Posterior odds(double best, double other, double twin, double chance, double slid = 0.0) {
  return {{best, other}, {0.9 * chance, twin, 0.1 * chance}, slid};
}

const std::vector<UnobservedFreedom> kHeld;
const std::vector<UnobservedFreedom> kOpen = {{false, Vector3d::UnitX(), "shift along (1.00, 0.00, 0.00)"}};

TEST(OutcomeOf, ABestPoseIsRegisteredAtTheRiskAndProbableAtTheOther) {
  EXPECT_EQ(outcome_of(odds(0.9991, 0.0009, 0.0, 0.0), kHeld), Outcome::registered);
  EXPECT_EQ(outcome_of(odds(0.9989, 0.0011, 0.0, 0.0), kHeld), Outcome::probable);
  EXPECT_EQ(outcome_of(odds(0.951, 0.0, 0.049, 0.0), kHeld), Outcome::probable);
  EXPECT_EQ(outcome_of(odds(0.949, 0.0, 0.051, 0.0), kHeld), Outcome::ambiguous);
  EXPECT_EQ(outcome_of(odds(0.951, 0.0, 0.0, 0.049), kHeld), Outcome::probable);
  VerdictOptions options;
  options.risk = 0.01;
  options.probable_risk = 0.2;
  EXPECT_EQ(outcome_of(odds(0.991, 0.009, 0.0, 0.0), kHeld, options), Outcome::registered);
  EXPECT_EQ(outcome_of(odds(0.81, 0.19, 0.0, 0.0), kHeld, options), Outcome::probable);
}

TEST(OutcomeOf, WhereSomethingIsOpenThePlaceHasToBeProbable) {
  EXPECT_EQ(outcome_of(odds(0.9999, 0.0001, 0.0, 0.0), kOpen), Outcome::under_constrained);
  EXPECT_EQ(outcome_of(odds(0.951, 0.049, 0.0, 0.0), kOpen), Outcome::under_constrained);
  EXPECT_EQ(outcome_of(odds(0.85, 0.0, 0.15, 0.0), kOpen), Outcome::ambiguous);
  // A pose further on along what is open is the same place, and no other pose where nothing is.
  EXPECT_EQ(outcome_of(odds(0.5, 0.5, 0.0, 0.0, 0.5), kOpen), Outcome::under_constrained);
  EXPECT_EQ(outcome_of(odds(0.5, 0.5, 0.0, 0.0), kOpen), Outcome::ambiguous);
  EXPECT_EQ(outcome_of(odds(0.5, 0.5, 0.0, 0.0, 0.5), kHeld), Outcome::ambiguous);
}

TEST(OutcomeOf, WhereNothingSharedIsLikelierThanAllElseNothingMatches) {
  EXPECT_EQ(outcome_of(odds(0.007, 0.0, 0.0, 0.993), kOpen), Outcome::no_match);
  EXPECT_EQ(outcome_of(odds(0.06, 0.1, 0.0, 0.84), kHeld), Outcome::no_match);
  EXPECT_EQ(outcome_of(odds(0.2, 0.19, 0.1, 0.51), kHeld), Outcome::no_match);
  EXPECT_EQ(outcome_of(odds(0.2, 0.21, 0.1, 0.49), kHeld), Outcome::ambiguous);
  // More probable than any single pose, but less than all of them and a twin.
  EXPECT_EQ(outcome_of(odds(0.2, 0.1, 0.3, 0.4), kHeld), Outcome::ambiguous);
  EXPECT_EQ(outcome_of({}, kHeld), Outcome::no_match);
}

Verdict found() {
  Verdict verdict;
  verdict.outcome = Outcome::registered;
  verdict.reason = "as judged";
  return verdict;
}

TEST(Decided, TheReasonTellsWhatElseMayBe) {
  const auto reason = [](const Posterior& all) { return decided(found(), all, {}, "a twin").reason; };
  EXPECT_EQ(reason(odds(0.9995, 0.0005, 0.0, 0.0)), "as judged");
  EXPECT_EQ(reason(odds(0.98631, 0.0, 0.01369, 0.0)),
            "placed, 98.6 % sure; the limit for registered is 99.9 %: a twin");
  // What is below the limit does not read as if it reached it.
  EXPECT_NE(reason(odds(0.99898, 0.00102, 0.0, 0.0)).find("99.89 %"), std::string::npos);
  EXPECT_EQ(reason(odds(0.7, 0.0, 0.2, 0.1)), "a twin");
  EXPECT_NE(reason(odds(0.7, 0.0, 0.1, 0.2)).find("chance (20.0 %)"), std::string::npos);
  EXPECT_NE(reason(odds(0.7, 0.2, 0.1, 0.0)).find("one of them may be right"), std::string::npos);
  EXPECT_NE(reason(odds(0.1, 0.0, 0.1, 0.8)).find("share nothing (80 %)"), std::string::npos);
}

TEST(Decided, WhatWasJudgedIsToldWhereItIsTheLikeliest) {
  Verdict rivals = found();
  rivals.outcome = Outcome::ambiguous;
  rivals.rivals = {1};
  EXPECT_EQ(decided(rivals, odds(0.7, 0.3, 0.0, 0.0), {}, "").reason, "as judged");
  EXPECT_NE(decided(rivals, odds(0.7, 0.1, 0.0, 0.2), {}, "").reason.find("chance"), std::string::npos);
  EXPECT_EQ(decided(rivals, odds(0.7, 0.1, 0.2, 0.0), {}, "a twin").reason, "a twin");
  Verdict chance = rivals;
  chance.rivals.clear();
  EXPECT_EQ(decided(chance, odds(0.7, 0.1, 0.0, 0.2), {}, "").reason, "as judged");
}

TEST(Decided, WhatIsRefusedStaysSoAndWhatIsUnsureIsAmbiguous) {
  Verdict refused;
  EXPECT_EQ(decided(refused, odds(1.0, 0.0, 0.0, 0.0), {}, "").outcome, Outcome::no_match);
  Verdict unsure = found();
  unsure.unsure = true;
  EXPECT_EQ(decided(unsure, odds(1.0, 0.0, 0.0, 0.0), {}, "").outcome, Outcome::ambiguous);
  EXPECT_EQ(decided(unsure, odds(0.1, 0.0, 0.0, 0.9), {}, "").outcome, Outcome::no_match);
}

TEST(Decided, WhatIsOpenIsNamedUnlessNothingMatches) {
  const Verdict open = decided(found(), odds(1.0, 0.0, 0.0, 0.0), {kOpen}, "");
  EXPECT_EQ(open.reason, "the common surface does not fix the shift along (1.00, 0.00, 0.00)");
  EXPECT_EQ(open.unobserved.size(), 1U);
  EXPECT_NE(decided(found(), odds(1.0, 0.0, 0.0, 0.0), {kOpen, true}, "").reason.find("drifts"),
            std::string::npos);
  EXPECT_TRUE(decided(found(), odds(0.1, 0.0, 0.0, 0.9), {kOpen}, "").unobserved.empty());
}

}  // namespace
}  // namespace limen
