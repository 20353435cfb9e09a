// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/base/text.h"

#include <cerrno>

#include <gtest/gtest.h>

namespace limen {
namespace {

TEST(Text, CasesAreThoseOfAscii) {
  EXPECT_EQ(upper_case("IfcWall_2 \xc3\xa4"), "IFCWALL_2 \xc3\xa4");
  EXPECT_EQ(lower_case("IfcWall_2 \xc3\x84"), "ifcwall_2 \xc3\x84");
}

TEST(Text, TrimmedKeepsWhatStandsBetween) {
  EXPECT_EQ(trimmed(" \t\r\na b\n "), "a b");
  EXPECT_EQ(trimmed(" \n"), "");
  EXPECT_EQ(trimmed(""), "");
}

TEST(Text, ReasonIsTold) {
  EXPECT_NE(reason_of(ENOENT), reason_of(EACCES));
  EXPECT_FALSE(reason_of(ENOENT).empty());
}

}  // namespace
}  // namespace limen
