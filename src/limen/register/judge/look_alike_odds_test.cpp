// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/judge/look_alike_odds.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <gtest/gtest.h>

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

SeenClutter seen(Observations pieces, std::vector<FaceMiss> offsets, double chance = 0.05) {
  SeenClutter clutter;
  clutter.pieces = pieces;
  for (double k = 0.0; k < pieces.count; ++k)  // things of one observation each, first those that agree
    clutter.things.push_back({1.0, std::clamp(pieces.agreeing() - k, 0.0, 1.0)});
  clutter.faces = std::move(offsets);
  clutter.chance = chance;
  return clutter;
}

double probability_of_look_alike(const SeenClutter& clutter, const LookAlikeOptions& options = {}) {
  return probability_of(weigh_look_alike(clutter, options));
}

double alike_of(const SeenClutter& clutter) {
  return against_alike(weigh_look_alike(clutter), 0.0);
}

TEST(LookAlikeOdds, WithoutEvidenceThePriorStands) {
  EXPECT_NEAR(odds_of(weigh_look_alike({})), LookAlikeOptions{}.otherwise + LookAlikeOptions{}.alike, 1e-12);
  SeenClutter apart;
  apart.behind_wall = true;
  EXPECT_NEAR(odds_of(weigh_look_alike(apart)),
              LookAlikeOptions{}.otherwise_behind_wall + LookAlikeOptions{}.alike, 1e-12);
}

TEST(LookAlikeOdds, ThingsThatAgreeToTheMillimetreMakeOneRoom) {
  EXPECT_LT(probability_of_look_alike(seen({10, 0.97}, faces(4, 0.002))), kRisk);
  // Of the things a third moved: still one room. So it is where measuring is twice as coarse as thought.
  EXPECT_LT(probability_of_look_alike(seen({20, 0.65}, faces(6, 0.002))), kRisk);
  EXPECT_LT(probability_of_look_alike(seen({20, 0.95}, faces(8, 0.004))), kRisk);
}

TEST(LookAlikeOdds, OfARoomInUseWhatStayedTellsTheRoom) {
  // Of what is nearby a half was pushed by hand; the rest agrees to a fraction of a millimetre.
  std::vector<FaceMiss> in_use = faces(6, 0.0005);
  for (FaceMiss pushed : faces(5, 0.012)) {
    pushed.thing += 6;
    in_use.push_back(pushed);
  }
  EXPECT_LT(probability_of_look_alike(seen({24, 0.7}, in_use)), kRisk);
  // If all of it was put up by hand, it may be a look-alike place.
  EXPECT_GT(probability_of_look_alike(seen({24, 0.7}, faces(11, 0.012))), kRisk);
}

TEST(LookAlikeOdds, ThingsThatAgreeByChanceMakeALookAlike) {
  EXPECT_GT(probability_of_look_alike(seen({8, 0.05}, {})), 0.5);
  EXPECT_GT(probability_of_look_alike(seen({30, 0.1}, {})), 0.8);
}

TEST(LookAlikeOdds, ThingsThatAgreeToCentimetresMayBeALookAlikeFurnishedAlike) {
  EXPECT_GT(probability_of_look_alike(seen({25, 0.98}, faces(8, 0.025))), 10.0 * kRisk);
  EXPECT_GT(probability_of_look_alike(seen({25, 0.98}, faces(8, 0.012))), kRisk);
  EXPECT_GT(probability_of_look_alike(seen({25, 0.98}, {})), kRisk);
  // Through a door two rooms would have to be alike: less is to be settled.
  SeenClutter apart = seen({12, 1.0}, {});
  EXPECT_GT(probability_of_look_alike(apart), kRisk);
  apart = seen({12, 1.0}, faces(2, 0.002));
  const double together = probability_of_look_alike(apart);
  apart.behind_wall = true;
  EXPECT_LT(probability_of_look_alike(apart), together);
}

TEST(LookAlikeOdds, WordsThatNothingRepeatsAreEvidenceAndNoMore) {
  const LookAlikeOptions stated = look_alike_options(true);
  // Two bare rooms stay in doubt, and so does what lies elsewhere.
  EXPECT_GT(probability_of_look_alike({}, stated), kRisk);
  EXPECT_GT(probability_of_look_alike(seen({20, 0.1}, faces(4, 0.02)), stated), 0.2);
  // Few things that agree are enough then.
  const SeenClutter few = seen({5, 1.0}, {});
  EXPECT_GT(probability_of_look_alike(few), kRisk);
  EXPECT_LT(probability_of_look_alike(few, stated), kRisk);
}

TEST(LookAlikeOdds, ThingsThatAreOthersAreEvidenceForALookAlikeFurnishedAlike) {
  EXPECT_NEAR(alike_of(seen({20, 1.0}, {})), 0.0, 1e-9);
  // Where most things are others', a room furnished alike is likelier than one that was used.
  EXPECT_LT(alike_of(seen({20, 0.3}, {})), -0.5);
}

/// What is built in is alike in all rooms of a drawing: to the millimetre, where it was built so.
TEST(LookAlikeOdds, OfABuildingAsDrawnThingsToTheMillimetreSayLess) {
  for (const double count : {1.0, 3.0, 9.0}) {
    const LookAlikeEvidence evidence =
        weigh_look_alike(seen({count, 1.0}, faces(static_cast<int>(count), 0.0005)));
    const double built = against_alike(evidence, 0.0);
    EXPECT_GT(built, 0.5) << count;
    EXPECT_LT(against_alike(evidence, 1.0), built - 0.3) << count;
    EXPECT_LT(against_otherwise(evidence, 1.0), against_otherwise(evidence, 0.0) - 0.3) << count;
  }
}

TEST(LookAlikeOdds, ThroughADoorNoBeliefAloneRegisters) {
  // However much agrees: where no face was seen by both, rooms furnished alike would look the same.
  SeenClutter apart = seen({60, 1.0}, {});
  apart.behind_wall = true;
  EXPECT_GT(probability_of_look_alike(apart), 1.5 * kRisk);
  // Nor does it against them in many pairs together.
  EXPECT_NEAR(alike_of(apart), 0.0, 1e-9);
  apart.faces = seen({60, 1.0}, faces(4, 0.001)).faces;
  EXPECT_LT(probability_of_look_alike(apart), kRisk);
}

TEST(LookAlikeOdds, SidesOfOneThingAreTheBuildingsTogether) {
  // A step of a flight, of which two sides are seen, is the same to the millimetre on every storey.
  std::vector<FaceMiss> sides = faces(2, 0.0002);
  const double of_two = alike_of(seen({8, 0.8}, sides));
  sides[1].thing = sides[0].thing;
  const double of_one = alike_of(seen({8, 0.8}, sides));
  EXPECT_LT(of_one, of_two - 0.3);
  // However little else agrees, one such thing does not make a landing the next one.
  EXPECT_GT(probability_of_look_alike(seen({8, 0.25}, sides)), 0.01);
}

TEST(LookAlikeOdds, OneThingIsTheBuildingsAsAWhole) {
  // A flight of stairs of so many pieces, all of which agree: it may be the building's.
  const auto flights = [](double pieces, std::size_t count) {
    SeenClutter stairs;
    stairs.chance = 0.2;
    stairs.things.assign(count, {pieces, pieces});
    for (std::size_t k = 0; k < count; ++k)
      stairs.faces.push_back({.offset_m = 0.0001, .sigma_m = 0.002, .thing = k});
    return against_otherwise(weigh_look_alike(stairs), 0.0);
  };
  const double of_one = flights(6.0, 1);
  EXPECT_GT(of_one, 3.0);
  EXPECT_LT(flights(60.0, 1) - of_one, 0.5);       // however large it is
  EXPECT_GT(flights(6.0, 4), of_one + 5.0);        // four of them are hardly all the building's
  EXPECT_LT(flights(6.0, 4), 4.0 * of_one - 1.0);  // but where one is, others are as well
}

TEST(LookAlikeOdds, PiecesOfOneFaceAreOneObservation) {
  std::vector<FaceMiss> one = faces(3, 0.002);
  std::vector<FaceMiss> split;
  for (int copy = 0; copy < 5; ++copy) split.insert(split.end(), one.begin(), one.end());
  for (FaceMiss& face : split) face.share = 0.2;
  EXPECT_NEAR(probability_of_look_alike(seen({10, 0.9}, split)),
              probability_of_look_alike(seen({10, 0.9}, one)), 1e-9);
}

TEST(LookAlikeOdds, WhatThingsMeetAnywayTellsLess) {
  EXPECT_GT(probability_of_look_alike(seen({6, 1.0}, faces(4, 0.002), 0.5)),
            probability_of_look_alike(seen({6, 1.0}, faces(4, 0.002), 0.02)));
}

}  // namespace
}  // namespace limen
