// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "support/test_support.h"
#include <gtest/gtest.h>

#include "limen/base/random.h"
#include "limen/io/pcd/pcd_header.h"

namespace limen {
namespace {

TEST(ExpandLzf, FollowsTheFormatByHand) {
  using std::string_literals::operator""s;
  EXPECT_EQ(expand_lzf("\x02"s + "abc", 3), "abc");
  // "ab", then 5 bytes from 2 back: an overlapping reference (length 3 in the control byte).
  EXPECT_EQ(expand_lzf("\x01"s + "ab" + "\x60\x01"s, 7), "abababa");
  // A long reference: 7 in the control byte, 20 more in the next; 29 bytes from 1 back.
  EXPECT_EQ(expand_lzf("\x00"s + "x" + "\xE0\x14\x00"s, 30), std::string(30, 'x'));
}

TEST(ExpandLzf, UndoesAPacking) {
  RandomStream random(1);
  for (int trial = 0; trial < 50; ++trial) {
    std::string plain;
    const std::uint32_t letters = 1 + random.below(20);
    const std::uint32_t size = 1 + random.below(20000);
    while (plain.size() < size) plain += static_cast<char>('a' + random.below(letters));
    EXPECT_EQ(expand_lzf(testing_io::pack_lzf(plain), plain.size()), plain);
  }
}

TEST(ExpandLzf, RefusesDamage) {
  using std::string_literals::operator""s;
  EXPECT_FALSE(expand_lzf("\x05"s + "abc", 6));              // run beyond the end
  EXPECT_FALSE(expand_lzf("\x02"s + "abc", 4));              // too short
  EXPECT_FALSE(expand_lzf("\x02"s + "abc", 2));              // too long
  EXPECT_FALSE(expand_lzf("\x00"s + "x" + "\x20\x05"s, 4));  // reference before the beginning
  EXPECT_FALSE(expand_lzf("\x00"s + "x" + "\xE0"s, 30));     // control byte cut
  EXPECT_FALSE(expand_lzf("", std::size_t{1} << 40U));       // nothing cannot become a terabyte
  std::string plain(500, 'q');
  plain += "abcabcabc";
  const std::string packed = testing_io::pack_lzf(plain);
  RandomStream random(2);
  for (int trial = 0; trial < 2000; ++trial) {
    std::string damaged = packed;
    damaged[random.below(static_cast<std::uint32_t>(damaged.size()))] = static_cast<char>(random.below(256));
    const auto expanded = expand_lzf(damaged, 509);  // any answer, no crash
    EXPECT_TRUE(!expanded || expanded->size() == 509U);
  }
}

}  // namespace
}  // namespace limen
