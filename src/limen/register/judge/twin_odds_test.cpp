// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/judge/twin_odds.h"

#include <gtest/gtest.h>

#include "limen/base/error.h"
#include "limen/register/judge/verdict.h"

namespace limen {
namespace {

constexpr double kRisk = 0.001;

IndividualMatter seen(Observations matter, Observations faces, double chance = 0.05) {
  IndividualMatter individual;
  individual.matter = matter;
  individual.faces = faces;
  individual.chance = chance;
  return individual;
}

TEST(TwinOdds, WithoutEvidenceThePriorStands) {
  EXPECT_NEAR(probability_of_twin({}), TwinOptions{}.prior, 1e-12);
}

TEST(TwinOdds, ThingsThatAgreeToTheMillimetreMakeOneRoom) {
  EXPECT_LT(probability_of_twin(seen({10, 0.97}, {4, 1.0})), kRisk);
  // A third of the things moved: still one room.
  EXPECT_LT(probability_of_twin(seen({20, 0.65}, {5, 0.95})), kRisk);
}

TEST(TwinOdds, ThingsThatAgreeByChanceMakeATwin) {
  EXPECT_GT(probability_of_twin(seen({8, 0.05}, {0, 0.0})), 0.9);
  EXPECT_GT(probability_of_twin(seen({12, 0.3}, {2, 0.2}, 0.2)), 0.5);
}

TEST(TwinOdds, ThingsThatAgreeToCentimetresMayBeATwinFurnishedAlike) {
  EXPECT_GT(probability_of_twin(seen({25, 0.98}, {8, 0.05})), 0.9);
  EXPECT_GT(probability_of_twin(seen({25, 0.98}, {0, 0.0})), kRisk);
  // Through a door two rooms would have to be alike.
  IndividualMatter apart = seen({12, 1.0}, {0, 0.0});
  EXPECT_GT(probability_of_twin(apart), kRisk);
  apart.apart = true;
  EXPECT_LT(probability_of_twin(apart), kRisk);
}

TEST(TwinOdds, WhatThingsMeetAnywayTellsLess) {
  EXPECT_GT(probability_of_twin(seen({6, 1.0}, {4, 1.0}, 0.5)),
            probability_of_twin(seen({6, 1.0}, {4, 1.0}, 0.02)));
}

TEST(TwinOdds, BoundsAreNamed) {
  TwinOptions options;
  options.prior = 1.0;
  EXPECT_THROW(probability_of_twin({}, options), Error);
  options = {};
  options.kept.mean = 1.0;
  EXPECT_THROW(probability_of_twin({}, options), Error);
}

TEST(TwinVerdict, ATwinIsNeverRegisteredAndTheReasonSaysSo) {
  Verdict verdict;
  verdict.outcome = Outcome::registered;
  EXPECT_EQ(with_twin(verdict, {}, 1e-5).outcome, Outcome::registered);
  const Verdict unsure = with_twin(verdict, {}, 0.15);
  EXPECT_EQ(unsure.outcome, Outcome::ambiguous);
  EXPECT_NE(unsure.reason.find("built alike"), std::string::npos) << unsure.reason;
  verdict.outcome = Outcome::no_match;
  EXPECT_EQ(with_twin(verdict, {}, 0.15).outcome, Outcome::no_match);
}

}  // namespace
}  // namespace limen
