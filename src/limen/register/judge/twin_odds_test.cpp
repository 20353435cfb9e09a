// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/judge/twin_odds.h"

#include <cmath>
#include <utility>

#include <gtest/gtest.h>

#include "limen/base/error.h"
#include "limen/register/judge/verdict.h"

namespace limen {
namespace {

constexpr double kRisk = 0.001;

/// `count` faces that stand on their own, their offsets of a normal deviation.
std::vector<FaceMiss> faces(int count, double deviation_m) {
  std::vector<FaceMiss> offsets;
  for (int k = 0; k < count; ++k) {
    // Quantiles of the even distribution, stretched: a spread of the deviation asked for.
    const double even = (k + 0.5) / count - 0.5;
    offsets.push_back({.offset_m = even * std::sqrt(12.0) * deviation_m, .sigma_m = 0.002, .thing = k});
  }
  return offsets;
}

IndividualMatter seen(Observations matter, std::vector<FaceMiss> offsets, double chance = 0.05) {
  IndividualMatter individual;
  individual.matter = matter;
  individual.faces = std::move(offsets);
  individual.chance = chance;
  return individual;
}

TEST(TwinOdds, WithoutEvidenceThePriorStands) {
  EXPECT_NEAR(weigh_twin({}).odds(), TwinOptions{}.otherwise + TwinOptions{}.alike, 1e-12);
  IndividualMatter apart;
  apart.apart = true;
  EXPECT_NEAR(weigh_twin(apart).odds(), TwinOptions{}.otherwise_apart + TwinOptions{}.alike, 1e-12);
}

TEST(TwinOdds, ThingsThatAgreeToTheMillimetreMakeOneRoom) {
  EXPECT_LT(probability_of_twin(seen({10, 0.97}, faces(4, 0.002))), kRisk);
  // Of the things a third moved: still one room. So it is where measuring is twice as coarse as thought.
  EXPECT_LT(probability_of_twin(seen({20, 0.65}, faces(6, 0.002))), kRisk);
  EXPECT_LT(probability_of_twin(seen({20, 0.95}, faces(6, 0.004))), kRisk);
}

TEST(TwinOdds, OfARoomInUseWhatStayedTellsTheRoom) {
  // Of what is nearby a half was pushed by hand; the rest agrees to a fraction of a millimetre.
  std::vector<FaceMiss> in_use = faces(6, 0.0005);
  for (FaceMiss pushed : faces(5, 0.012)) {
    pushed.thing += 6;
    in_use.push_back(pushed);
  }
  EXPECT_LT(probability_of_twin(seen({24, 0.7}, in_use)), kRisk);
  // If all of it was put up by hand, it may be a twin.
  EXPECT_GT(probability_of_twin(seen({24, 0.7}, faces(11, 0.012))), kRisk);
}

TEST(TwinOdds, ThingsThatAgreeByChanceMakeATwin) {
  EXPECT_GT(probability_of_twin(seen({8, 0.05}, {})), 0.5);
  EXPECT_GT(probability_of_twin(seen({30, 0.1}, {})), 0.8);
}

TEST(TwinOdds, ThingsThatAgreeToCentimetresMayBeATwinFurnishedAlike) {
  EXPECT_GT(probability_of_twin(seen({25, 0.98}, faces(8, 0.025))), 10.0 * kRisk);
  EXPECT_GT(probability_of_twin(seen({25, 0.98}, faces(8, 0.012))), kRisk);
  EXPECT_GT(probability_of_twin(seen({25, 0.98}, {})), kRisk);
  // Through a door two rooms would have to be alike: less is to be settled.
  IndividualMatter apart = seen({12, 1.0}, {});
  EXPECT_GT(probability_of_twin(apart), kRisk);
  apart = seen({12, 1.0}, faces(2, 0.002));
  const double together = probability_of_twin(apart);
  apart.apart = true;
  EXPECT_LT(probability_of_twin(apart), together);
}

TEST(TwinOdds, WordsThatNothingRepeatsAreEvidenceAndNoMore) {
  const TwinOptions stated = where_nothing_repeats({});
  // Two bare rooms stay in doubt, and so does what lies elsewhere.
  EXPECT_GT(probability_of_twin({}, stated), kRisk);
  EXPECT_GT(probability_of_twin(seen({20, 0.1}, faces(4, 0.02)), stated), 0.2);
  // Few things that agree are enough then.
  const IndividualMatter few = seen({5, 1.0}, {});
  EXPECT_GT(probability_of_twin(few), kRisk);
  EXPECT_LT(probability_of_twin(few, stated), kRisk);
}

TEST(TwinOdds, ThingsThatAreOthersSpeakForATwinFurnishedAlike) {
  const std::vector<FaceMiss> few = faces(3, 0.002);
  const double all = weigh_twin(seen({20, 1.0}, few)).alike_nats;
  EXPECT_DOUBLE_EQ(all, weigh_twin(seen({0, 0.0}, few)).alike_nats);
  // A third of the things lies elsewhere: so it is in one pair of five of one room, and in most of those.
  EXPECT_LT(weigh_twin(seen({20, 0.65}, few)).alike_nats, all - 0.5);
}

TEST(TwinOdds, ThroughADoorNoBeliefAloneRegisters) {
  // However much agrees: where no face was seen by both, rooms furnished alike would look the same.
  IndividualMatter apart = seen({60, 1.0}, {});
  apart.apart = true;
  EXPECT_GT(probability_of_twin(apart), 1.5 * kRisk);
  // Nor does it against them in many pairs together.
  EXPECT_DOUBLE_EQ(weigh_twin(apart).alike_nats, 0.0);
  apart.faces = seen({60, 1.0}, faces(4, 0.001)).faces;
  EXPECT_LT(probability_of_twin(apart), kRisk);
}

TEST(TwinOdds, FrontsOfCupboardsTellLessThanTheirSides) {
  // Things of one make that stand flush with a wall reach equally far from it, in any room.
  IndividualMatter sides = seen({12, 1.0}, faces(5, 0.002));
  sides.apart = true;
  IndividualMatter fronts = sides;
  for (FaceMiss& face : fronts.faces) face.front = true;
  EXPECT_LT(probability_of_twin(sides), kRisk);
  EXPECT_GT(probability_of_twin(fronts), kRisk);
  // Where they differ they tell as much.
  EXPECT_GT(probability_of_twin(seen({12, 1.0}, faces(5, 0.03))), kRisk);
}

TEST(TwinOdds, SidesOfOneThingAreTheBuildingsTogether) {
  // A step of a flight, of which two sides are seen, is the same to the millimetre on every storey.
  std::vector<FaceMiss> sides = faces(2, 0.0002);
  const double of_two = weigh_twin(seen({8, 0.8}, sides)).alike_nats;
  sides[1].thing = sides[0].thing;
  const double of_one = weigh_twin(seen({8, 0.8}, sides)).alike_nats;
  EXPECT_LT(of_one, of_two - 0.5);
  EXPECT_GT(of_one, weigh_twin(seen({8, 0.8}, faces(1, 0.0002))).alike_nats);
}

TEST(TwinOdds, PiecesOfOneFaceAreOneObservation) {
  std::vector<FaceMiss> one = faces(3, 0.002);
  std::vector<FaceMiss> split;
  for (int copy = 0; copy < 5; ++copy) split.insert(split.end(), one.begin(), one.end());
  for (FaceMiss& face : split) face.share = 0.2;
  EXPECT_NEAR(probability_of_twin(seen({10, 0.9}, split)), probability_of_twin(seen({10, 0.9}, one)), 1e-9);
}

TEST(TwinOdds, WhatThingsMeetAnywayTellsLess) {
  EXPECT_GT(probability_of_twin(seen({6, 1.0}, faces(4, 0.002), 0.5)),
            probability_of_twin(seen({6, 1.0}, faces(4, 0.002), 0.02)));
}

TEST(TwinOdds, BoundsAreNamed) {
  TwinOptions options;
  options.otherwise = -1.0;
  EXPECT_THROW(probability_of_twin({}, options), Error);
  options = {};
  options.kept.mean = 1.0;
  EXPECT_THROW(probability_of_twin({}, options), Error);
}

}  // namespace
}  // namespace limen
