// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "limen/report/summary/summary_text.h"

namespace limen {
namespace {

RegistrationResult result_of(double best, const std::vector<double>& alternatives, double look_alike,
                             double nothing_shared) {
  RegistrationResult result;
  result.best.probability = best;
  for (const double probability : alternatives) {
    result.alternatives.emplace_back();
    result.alternatives.back().probability = probability;
  }
  result.others = OtherExplanations{nothing_shared, look_alike, 0.0};
  return result;
}

using Indices = std::vector<std::size_t>;

TEST(AnswerPlaces, TheLikeliestThatReachMostOfWhatIsShared) {
  EXPECT_EQ(answer_places(result_of(0.5, {0.3, 0.16, 0.03, 0.01}, 0.0, 0.0)).alternatives, (Indices{0, 1}));
  // What is chance is no place: 0.95 of the other 0.6 is reached earlier.
  EXPECT_EQ(answer_places(result_of(0.4, {0.17, 0.02, 0.01}, 0.0, 0.4)).alternatives, (Indices{0}));
  EXPECT_TRUE(answer_places(result_of(0.96, {0.04}, 0.0, 0.0)).alternatives.empty());
}

TEST(AnswerPlaces, APlaceBuiltAlikeIsOneOfThem) {
  const AnswerPlaces look_alike = answer_places(result_of(0.8, {0.03}, 0.17, 0.0));
  EXPECT_TRUE(look_alike.look_alike);
  EXPECT_TRUE(look_alike.alternatives.empty());
  EXPECT_FALSE(answer_places(result_of(0.6, {0.37}, 0.03, 0.0)).look_alike);
}

TEST(AnswerPlaces, AllWhereNoProbabilityIsStated) {
  RegistrationResult result = result_of(0.5, {0.4, 0.1}, 0.0, 0.0);
  result.others.reset();
  EXPECT_EQ(answer_places(result).alternatives.size(), 2U);
}

}  // namespace
}  // namespace limen
