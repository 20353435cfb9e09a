// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/project_graph.h"

#include <gtest/gtest.h>

namespace limen {
namespace {

/// What a pair told whose twin has this probability.
RegistrationResult told(Outcome outcome, double twin, std::size_t rivals = 0) {
  RegistrationResult result;
  result.outcome = outcome;
  result.best.probability = 1.0 - twin;
  result.best.score = 30.0;
  result.best.agreeing_m2 = 30.0;
  result.rivals = rivals;
  result.others = OtherExplanations{0.0, twin, 0.0};
  if (rivals > 0) result.alternatives.push_back(result.best);
  return result;
}

std::vector<GraphLink> links_of(const RegistrationResult& pair, double risk) {
  std::vector<ProjectNode> nodes(2);
  nodes[1].scan = 1;
  return make_graph(nodes, {{1, 0, pair}}, risk).graph.links;
}

TEST(ProjectGraph, ATwinThatIsMoreProbableThanTheRiskMakesALinkNoMoreThanLikely) {
  const auto trust = [](const RegistrationResult& pair, double risk) {
    const std::vector<GraphLink> links = links_of(pair, risk);
    EXPECT_EQ(links.size(), 1U);
    return links.front().trust;
  };
  EXPECT_EQ(trust(told(Outcome::registered, 0.0005), 0.001), LinkTrust::sure);
  EXPECT_EQ(trust(told(Outcome::registered, 0.0005), 0.0001), LinkTrust::likely);
  // The pair called it ambiguous by its own risk; the project's may be larger.
  EXPECT_EQ(trust(told(Outcome::ambiguous, 0.01), 0.001), LinkTrust::likely);
  EXPECT_EQ(trust(told(Outcome::ambiguous, 0.01), 0.05), LinkTrust::sure);
  EXPECT_EQ(trust(told(Outcome::ambiguous, 0.01, 1), 0.05), LinkTrust::open);
  EXPECT_EQ(trust(told(Outcome::under_constrained, 0.0), 0.001), LinkTrust::weak);
}

TEST(ProjectGraph, WhatATwinExplainsBetterIsNoLink) {
  EXPECT_TRUE(links_of(told(Outcome::ambiguous, 0.6), 0.001).empty());
  EXPECT_TRUE(links_of(told(Outcome::no_match, 0.0), 0.001).empty());
}

TEST(ProjectGraph, APairThatDoesNotKnowItselfIsNotSure) {
  RegistrationResult pair = told(Outcome::registered, 0.0);
  pair.best.probability = 0.7;
  EXPECT_NEAR(links_of(pair, 0.001).front().chance, 0.3, 1e-12);
  pair.others.reset();
  EXPECT_GT(links_of(pair, 0.001).front().chance, 0.001);
}

}  // namespace
}  // namespace limen
