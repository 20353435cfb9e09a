// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/graph/twin_rate.h"

#include <gtest/gtest.h>

namespace limen {
namespace {

constexpr int kNodes = 100;
constexpr double kAlone = 0.15;

/// Pairs in a row, whose things leave these probabilities of a twin by themselves.
std::vector<TwinWitness> pairs_in_a_row(const std::vector<double>& probabilities) {
  std::vector<TwinWitness> witnesses;
  for (std::size_t k = 0; k < probabilities.size(); ++k)
    witnesses.push_back({static_cast<int>(k), static_cast<int>(k + 1), twin_evidence_of(probabilities[k])});
  return witnesses;
}

/// What is believed of a link of the last node.
double believed(const std::vector<TwinWitness>& witnesses) {
  std::vector<bool> last(kNodes, false);
  last.back() = true;
  const TwinFactors factors = TwinRate(kNodes, witnesses).factors(last);
  return TwinEvidence{}.otherwise * factors.otherwise + TwinEvidence{}.alike * factors.alike;
}

TEST(TwinRate, WhatSaysNothingTeachesNothing) {
  EXPECT_NEAR(believed({}), kAlone, 1e-12);
  EXPECT_NEAR(believed(pairs_in_a_row({kAlone, kAlone, kAlone})), kAlone, 1e-9);
}

TEST(TwinRate, RoomsThatAreKnownAsOneMakeTwinsRarerAndTwinsMakeThemMoreFrequent) {
  // Beta(0.15, 0.85) after n pairs of one room has the mean 0.15 / (1 + n), after one twin 1.15 / 2.
  EXPECT_NEAR(believed(pairs_in_a_row({1e-9})), kAlone / 2.0, 2e-3);
  EXPECT_NEAR(believed(pairs_in_a_row({1e-9, 1e-9, 1e-9, 1e-9})), kAlone / 5.0, 2e-3);
  EXPECT_NEAR(believed(pairs_in_a_row({1.0 - 1e-9})), (1.0 + kAlone) / 2.0, 1e-2);
}

TEST(TwinRate, OneRoomSeenFromManyPlacesIsOne) {
  const std::vector<TwinWitness> row = pairs_in_a_row({1e-9, 1e-9});
  std::vector<TwinWitness> loop = row;
  loop.push_back({0, 2, twin_evidence_of(1e-9)});
  EXPECT_EQ(believed(loop), believed(row));
}

TEST(TwinRate, WhatLeadsAcrossTeachesItselfNothing) {
  std::vector<TwinWitness> witnesses = pairs_in_a_row({1e-9, 1e-9});
  const double before = believed(witnesses);
  witnesses.push_back({5, kNodes - 1, twin_evidence_of(1e-6)});
  EXPECT_NEAR(believed(witnesses), before, 1e-12);
}

TEST(TwinRate, NoNumberOfOtherRoomsMakesBareOnesTheSame) {
  EXPECT_NEAR(believed(pairs_in_a_row(std::vector<double>(60, 1e-9))), kAlone / 15.0, 1e-12);
}

/// What is told of both kinds by `count` pairs that say so much against either.
TwinFactors told_by(std::size_t count, double otherwise_nats, double alike_nats) {
  std::vector<TwinWitness> witnesses;
  for (int k = 0; k < static_cast<int>(count); ++k) {
    TwinEvidence said;
    said.otherwise_nats = otherwise_nats;
    said.alike_nats = alike_nats;
    witnesses.push_back({k, k + 1, said});
  }
  return TwinRate(kNodes, witnesses).factors(std::vector<bool>(kNodes, false));
}

TEST(TwinRate, WhatTellsThingsApartSaysNothingOfTwinsThatAreFurnishedAlike) {
  const TwinFactors things = told_by(10, 9.0, 0.0);
  EXPECT_LT(things.otherwise, 0.1);
  EXPECT_NEAR(things.alike, 1.0, 1e-3);
  // However many twins furnished otherwise there are.
  EXPECT_NEAR(told_by(10, -4.0, 0.0).alike, 1.0, 1e-9);
  const TwinFactors faces = told_by(10, 9.0, 9.0);
  EXPECT_NEAR(faces.otherwise, 1.0 / 11.0, 2e-3);
  EXPECT_NEAR(faces.alike, 0.85 / 10.85, 0.02);  // their shares are few
}

TEST(TwinRate, TwinsThatAreFoundTeachOfTheirOwnKind) {
  const TwinFactors alike = told_by(3, 8.0, -4.0);
  EXPECT_GT(alike.alike, 5.0);
  EXPECT_LT(alike.otherwise, 0.5);
  const TwinFactors otherwise = told_by(3, -8.0, 4.0);
  EXPECT_GT(otherwise.otherwise, 4.0);
  EXPECT_LT(otherwise.alike, 1.5);
}

}  // namespace
}  // namespace limen
