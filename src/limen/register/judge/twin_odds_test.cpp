// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/judge/twin_odds.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
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
    offsets.push_back({.offset_m = even * std::sqrt(12.0) * deviation_m,
                       .sigma_m = 0.002,
                       .thing = static_cast<std::size_t>(k)});
  }
  return offsets;
}

IndividualMatter seen(Observations matter, std::vector<FaceMiss> offsets, double chance = 0.05) {
  IndividualMatter individual;
  individual.matter = matter;
  for (double k = 0.0; k < matter.count; ++k)  // things of one observation each, first those that agree
    individual.things.push_back({1.0, std::clamp(matter.agreeing() - k, 0.0, 1.0)});
  individual.faces = std::move(offsets);
  individual.chance = chance;
  return individual;
}

double twin_of(const IndividualMatter& individual, const TwinOptions& options = {}) {
  return probability_of(weigh_twin(individual, options));
}

double alike_of(const IndividualMatter& individual) {
  return against_alike(weigh_twin(individual), 0.0);
}

TEST(TwinOdds, WithoutEvidenceThePriorStands) {
  EXPECT_NEAR(odds_of(weigh_twin({})), TwinOptions{}.otherwise + TwinOptions{}.alike, 1e-12);
  IndividualMatter apart;
  apart.apart = true;
  EXPECT_NEAR(odds_of(weigh_twin(apart)), TwinOptions{}.otherwise_apart + TwinOptions{}.alike, 1e-12);
}

TEST(TwinOdds, ThingsThatAgreeToTheMillimetreMakeOneRoom) {
  EXPECT_LT(twin_of(seen({10, 0.97}, faces(4, 0.002))), kRisk);
  // Of the things a third moved: still one room. So it is where measuring is twice as coarse as thought.
  EXPECT_LT(twin_of(seen({20, 0.65}, faces(6, 0.002))), kRisk);
  EXPECT_LT(twin_of(seen({20, 0.95}, faces(8, 0.004))), kRisk);
}

TEST(TwinOdds, OfARoomInUseWhatStayedTellsTheRoom) {
  // Of what is nearby a half was pushed by hand; the rest agrees to a fraction of a millimetre.
  std::vector<FaceMiss> in_use = faces(6, 0.0005);
  for (FaceMiss pushed : faces(5, 0.012)) {
    pushed.thing += 6;
    in_use.push_back(pushed);
  }
  EXPECT_LT(twin_of(seen({24, 0.7}, in_use)), kRisk);
  // If all of it was put up by hand, it may be a twin.
  EXPECT_GT(twin_of(seen({24, 0.7}, faces(11, 0.012))), kRisk);
}

TEST(TwinOdds, ThingsThatAgreeByChanceMakeATwin) {
  EXPECT_GT(twin_of(seen({8, 0.05}, {})), 0.5);
  EXPECT_GT(twin_of(seen({30, 0.1}, {})), 0.8);
}

TEST(TwinOdds, ThingsThatAgreeToCentimetresMayBeATwinFurnishedAlike) {
  EXPECT_GT(twin_of(seen({25, 0.98}, faces(8, 0.025))), 10.0 * kRisk);
  EXPECT_GT(twin_of(seen({25, 0.98}, faces(8, 0.012))), kRisk);
  EXPECT_GT(twin_of(seen({25, 0.98}, {})), kRisk);
  // Through a door two rooms would have to be alike: less is to be settled.
  IndividualMatter apart = seen({12, 1.0}, {});
  EXPECT_GT(twin_of(apart), kRisk);
  apart = seen({12, 1.0}, faces(2, 0.002));
  const double together = twin_of(apart);
  apart.apart = true;
  EXPECT_LT(twin_of(apart), together);
}

TEST(TwinOdds, WordsThatNothingRepeatsAreEvidenceAndNoMore) {
  const TwinOptions stated = twin_options(true);
  // Two bare rooms stay in doubt, and so does what lies elsewhere.
  EXPECT_GT(twin_of({}, stated), kRisk);
  EXPECT_GT(twin_of(seen({20, 0.1}, faces(4, 0.02)), stated), 0.2);
  // Few things that agree are enough then.
  const IndividualMatter few = seen({5, 1.0}, {});
  EXPECT_GT(twin_of(few), kRisk);
  EXPECT_LT(twin_of(few, stated), kRisk);
}

TEST(TwinOdds, ThingsThatAreOthersSpeakForATwinFurnishedAlike) {
  EXPECT_NEAR(alike_of(seen({20, 1.0}, {})), 0.0, 1e-9);
  // Where most things are others', a room furnished alike is likelier than one that was used.
  EXPECT_LT(alike_of(seen({20, 0.3}, {})), -0.5);
}

/// What is built in is alike in all rooms of a drawing: to the millimetre, where it was built so.
TEST(TwinOdds, OfABuildingAsDrawnThingsToTheMillimetreSayLess) {
  for (const double count : {1.0, 3.0, 9.0}) {
    const TwinEvidence evidence = weigh_twin(seen({count, 1.0}, faces(static_cast<int>(count), 0.0005)));
    const double built = against_alike(evidence, 0.0);
    EXPECT_GT(built, 0.5) << count;
    EXPECT_LT(against_alike(evidence, 1.0), built - 0.3) << count;
    EXPECT_LT(against_otherwise(evidence, 1.0), against_otherwise(evidence, 0.0) - 0.3) << count;
  }
}

TEST(TwinOdds, ThroughADoorNoBeliefAloneRegisters) {
  // However much agrees: where no face was seen by both, rooms furnished alike would look the same.
  IndividualMatter apart = seen({60, 1.0}, {});
  apart.apart = true;
  EXPECT_GT(twin_of(apart), 1.5 * kRisk);
  // Nor does it against them in many pairs together.
  EXPECT_NEAR(alike_of(apart), 0.0, 1e-9);
  apart.faces = seen({60, 1.0}, faces(4, 0.001)).faces;
  EXPECT_LT(twin_of(apart), kRisk);
}

TEST(TwinOdds, SidesOfOneThingAreTheBuildingsTogether) {
  // A step of a flight, of which two sides are seen, is the same to the millimetre on every storey.
  std::vector<FaceMiss> sides = faces(2, 0.0002);
  const double of_two = alike_of(seen({8, 0.8}, sides));
  sides[1].thing = sides[0].thing;
  const double of_one = alike_of(seen({8, 0.8}, sides));
  EXPECT_LT(of_one, of_two - 0.3);
  // However little else agrees, one such thing does not make a landing the next one.
  EXPECT_GT(twin_of(seen({8, 0.25}, sides)), 0.01);
}

TEST(TwinOdds, OneThingIsTheBuildingsAsAWhole) {
  // A flight of stairs of so many pieces, all of which agree: it may be the building's.
  const auto flights = [](double pieces, std::size_t count) {
    IndividualMatter stairs;
    stairs.chance = 0.2;
    stairs.things.assign(count, {pieces, pieces});
    for (std::size_t k = 0; k < count; ++k)
      stairs.faces.push_back({.offset_m = 0.0001, .sigma_m = 0.002, .thing = k});
    return against_otherwise(weigh_twin(stairs), 0.0);
  };
  const double of_one = flights(6.0, 1);
  EXPECT_GT(of_one, 3.0);
  EXPECT_LT(flights(60.0, 1) - of_one, 0.5);       // however large it is
  EXPECT_GT(flights(6.0, 4), of_one + 5.0);        // four of them are hardly all the building's
  EXPECT_LT(flights(6.0, 4), 4.0 * of_one - 1.0);  // but where one is, others are as well
}

TEST(TwinOdds, PiecesOfOneFaceAreOneObservation) {
  std::vector<FaceMiss> one = faces(3, 0.002);
  std::vector<FaceMiss> split;
  for (int copy = 0; copy < 5; ++copy) split.insert(split.end(), one.begin(), one.end());
  for (FaceMiss& face : split) face.share = 0.2;
  EXPECT_NEAR(twin_of(seen({10, 0.9}, split)), twin_of(seen({10, 0.9}, one)), 1e-9);
}

TEST(TwinOdds, WhatThingsMeetAnywayTellsLess) {
  EXPECT_GT(twin_of(seen({6, 1.0}, faces(4, 0.002), 0.5)), twin_of(seen({6, 1.0}, faces(4, 0.002), 0.02)));
}

TEST(TwinOdds, BoundsAreNamed) {
  TwinOptions options;
  options.otherwise = -1.0;
  EXPECT_THROW(twin_of({}, options), Error);
}

}  // namespace
}  // namespace limen
