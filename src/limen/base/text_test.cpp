// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/base/text.h"

#include <cerrno>
#include <limits>

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

TEST(Text, WhatCommandsATerminalIsNotShown) {
  EXPECT_EQ(printable("scan 1: \"a\""), "scan 1: \"a\"");
  EXPECT_EQ(printable("\x1b[2J\r\x7f"), "?[2J??");
  EXPECT_EQ(printable("Gr\xc3\xbc\xc3\x9f\x65 \xe2\x82\xac \xf0\x9f\x8f\xa0"),
            "Gr\xc3\xbc\xc3\x9f\x65 \xe2\x82\xac \xf0\x9f\x8f\xa0");
  EXPECT_EQ(printable("\xc2\x9b\x33\x31m"), "??31m") << "a control beyond ASCII";
  EXPECT_EQ(printable("\xff\xc3(\xe2\x82"),
            "?"
            "?(?"
            "?")
      << "no UTF-8, and half of a character";
  EXPECT_EQ(printable("\xc0\xaf\xed\xa0\x80\xf4\x90\x80\x80"), "?????????") << "no characters of Unicode";
}

TEST(Text, ACharacterThatTurnsTheLineRoundIsWrittenAsItsNumber) {
  EXPECT_EQ(printable("scan\xe2\x80\xaeylp.exe"), "scan\\u202Eylp.exe");
  EXPECT_EQ(printable("\xd8\x9c\xe2\x81\xa6\xe2\x80\xa8"), "\\u061C\\u2066\\u2028");
  // Letters that are written from the right, and what joins them, are letters.
  const std::string persian = "\xd9\x85\xdb\x8c\xe2\x80\x8c\xd8\xae";
  EXPECT_EQ(printable(persian), persian);
}

TEST(Text, LinesAndTabsStayWhereLinesAreShown) {
  EXPECT_EQ(printable_lines("a\tb\n\x1b[2J\n"), "a\tb\n?[2J\n");
  EXPECT_EQ(printable_lines(""), "");
}

TEST(Text, AShortenedTextKeepsItsBeginningAndItsEnd) {
  EXPECT_EQ(shortened("short", 5), "short");
  const std::string text = "begin" + std::string(5000, 'x') + "end";
  const std::string shown = shortened(text, 300);
  EXPECT_LE(shown.size(), 300U);
  EXPECT_TRUE(shown.starts_with("beginx"));
  EXPECT_TRUE(shown.ends_with("xend"));
  EXPECT_NE(shown.find(" bytes left out] "), std::string::npos) << shown;
  // No character is cut in two.
  std::string wide;
  for (int k = 0; k < 1000; ++k) wide += "\xe2\x82\xac";
  for (std::size_t most = 100; most < 110; ++most) EXPECT_TRUE(is_utf8(shortened(wide, most))) << most;
}

TEST(Text, Utf8MayHoldControlsAndNoOtherBytes) {
  EXPECT_TRUE(is_utf8(""));
  EXPECT_TRUE(is_utf8("a\tb\x1b Gr\xc3\xbc\xc3\x9f\x65 \xf0\x9f\x8f\xa0"));
  EXPECT_FALSE(is_utf8("caf\xe9.ply"));
  EXPECT_FALSE(is_utf8("a\xc3"));
  EXPECT_FALSE(is_utf8("\xed\xa0\x80"));
}

TEST(Text, BytesOfNoCharacterAreReplacedAndAllOthersStay) {
  const std::string sound = "a\tb Gr\xc3\xbc\xc3\x9f\x65 \xf0\x9f\x8f\xa0";
  EXPECT_EQ(as_utf8(sound), sound);
  EXPECT_EQ(as_utf8("caf\xe9.ply"), "caf\xEF\xBF\xBD.ply");
  EXPECT_EQ(as_utf8("a\xc3"), "a\xEF\xBF\xBD");
  EXPECT_TRUE(is_utf8(as_utf8("\xed\xa0\x80\xff")));
}

TEST(Text, WordsForAShellAreReadBack) {
  const std::vector<std::string> words = {"accept",       "z1.e57 #0", "o'clock.ply", "", "a\\b",
                                          "my  scan.ply", "2"};
  std::string line;
  for (const std::string& word : words) line += (line.empty() ? "" : " ") + shell_word(word);
  EXPECT_EQ(shell_words(line), words);
  EXPECT_TRUE(shell_words("  ").empty());
}

TEST(Text, ProbabilitiesAreShortAndNeverRoundedToCertainty) {
  EXPECT_EQ(percent_words(0.0), "less than 0.01 %");
  EXPECT_EQ(percent_words(0.0003), "0.03 %");
  EXPECT_EQ(percent_words(0.034), "3.4 %");
  EXPECT_EQ(percent_words(0.44), "44 %");
  EXPECT_EQ(percent_words(0.9689), "96.8 %");
  EXPECT_EQ(percent_words(0.99987), "99.98 %");
  EXPECT_EQ(percent_words(1.0), "more than 99.99 %");
  EXPECT_EQ(percent_words(std::numeric_limits<double>::quiet_NaN()), "—");
}

TEST(Text, ReasonIsStated) {
  EXPECT_NE(reason_of(ENOENT), reason_of(EACCES));
  EXPECT_FALSE(reason_of(ENOENT).empty());
}

}  // namespace
}  // namespace limen
