// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "limen/cli/terminal/command_line.h"

namespace limen {
namespace {

TEST(NearestWord, CountsEditsAndSwaps) {
  EXPECT_EQ(edit_distance("", "abc"), 3U);
  EXPECT_EQ(edit_distance("regster", "register"), 1U);
  EXPECT_EQ(edit_distance("outptu", "output"), 1U);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3U);
}

TEST(NearestWord, FindsWhatWasMeantAndNothingElse) {
  const std::vector<std::string> known = {"info", "register", "transform", "thin"};
  EXPECT_EQ(nearest_word("regster", known), "register");
  EXPECT_EQ(nearest_word("trans", known), "transform");
  EXPECT_EQ(nearest_word("thn", known), "thin");
  EXPECT_EQ(nearest_word("bake", known), "");
  EXPECT_EQ(nearest_word("x", known), "");
  EXPECT_EQ(nearest_word("register", {}), "");
}

}  // namespace
}  // namespace limen
