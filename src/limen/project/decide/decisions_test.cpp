// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/decide/decisions.h"

#include <gtest/gtest.h>

#include "limen/base/error.h"

namespace limen {
namespace {

std::vector<std::string> words(const std::vector<Decision>& decisions) {
  std::vector<std::string> list;
  for (const Decision& decision : decisions) list.push_back(words_of(decision));
  return list;
}

TEST(Decisions, WordsComeBackAsTheyWereAndPairsInOneOrder) {
  EXPECT_EQ(words_of(decision_from({"choose", "b.ply", "a.ply", "2"})), "choose a.ply b.ply 2");
  EXPECT_EQ(words_of(decision_from({"level", "a.ply"})), "level a.ply");
  EXPECT_EQ(words_of(decision_from({"same-floor", "b", "a"})), "same-floor a b");
  EXPECT_EQ(words_of(decision_from({"accept", "b.ply", "all.e57 #0"})), "accept 'all.e57 #0' b.ply");
  const std::vector<std::vector<std::string>> faults = {{},
                                                        {"agree", "a", "b"},
                                                        {"accept", "a"},
                                                        {"accept", "a", "a"},
                                                        {"choose", "a", "b"},
                                                        {"level", "a", "b"}};
  for (const std::vector<std::string>& bad : faults)
    EXPECT_THROW(static_cast<void>(decision_from(bad)), Error);
}

TEST(Decisions, TheLaterWordCountsAndForgetTakesBack) {
  const auto say = [](const std::vector<std::vector<std::string>>& all) {
    std::vector<Decision> decisions;
    for (const std::vector<std::string>& one : all) decisions = merged(decisions, {decision_from(one)});
    return words(decisions);
  };
  using Words = std::vector<std::string>;
  EXPECT_EQ(say({{"accept", "a", "b"}, {"reject", "b", "a"}}), Words{"reject a b"});
  EXPECT_EQ(say({{"same-floor", "a", "b"}, {"reject", "b", "a"}, {"level", "a"}}),
            (Words{"level a", "reject a b", "same-floor a b"}));
  EXPECT_EQ(say({{"same-floor", "a", "b"}, {"reject", "b", "a"}, {"level", "a"}, {"forget", "b", "a"}}),
            Words{"level a"});
}

}  // namespace
}  // namespace limen
