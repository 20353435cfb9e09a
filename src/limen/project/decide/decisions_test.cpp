// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/decide/decisions.h"

#include <gtest/gtest.h>

#include "limen/base/atomic_file.h"
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
  // Files of one name in two folders are two scans.
  EXPECT_EQ(
      say({{"accept", "1.ply", "2.ply"}, {"accept", "e/1.ply", "e/2.ply"}, {"forget", "e/1.ply", "e/2.ply"}}),
      Words{"accept 1.ply 2.ply"});
}

TEST(Decisions, AStartIsOfItsScansInEitherOrderAndOutlastsTheAnswerAboutItsLink) {
  const std::vector<std::string> start = {"start", "b", "a", "0,0,1=9,0,1", "5,0,1=14,0,1", "5,4,1=14,4,1"};
  const Decision decision = decision_from(start);
  EXPECT_EQ(words_of(decision), "start a b 9,0,1=0,0,1 14,0,1=5,0,1 14,4,1=5,4,1");
  const auto with = [&](const std::vector<std::string>& later) {
    return merged({decision}, {decision_from(later)}).size();
  };
  EXPECT_EQ(with({"accept", "a", "b"}), 2);
  EXPECT_EQ(with({"reject", "a", "b"}), 1);
  EXPECT_EQ(merged({decision_from({"reject", "a", "b"})}, {decision}).size(), 1);
  EXPECT_THROW(static_cast<void>(decision_from({start.begin(), start.end() - 1})), Error);
  const std::filesystem::path path = std::filesystem::path(::testing::TempDir()) / "start_decision.json";
  write_file(path, decisions_text({decision}));
  EXPECT_EQ(words_of(read_decisions(path).at(0)), words_of(decision));
}

}  // namespace
}  // namespace limen
