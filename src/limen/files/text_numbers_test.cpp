// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/files/text_numbers.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "limen/base/random.h"

namespace limen {
namespace {

/// A number in one of the spellings that files have.
std::string random_spelling(RandomStream& random) {
  const double value = (random.uniform() - 0.5) * std::pow(10.0, static_cast<double>(random.below(16)));
  switch (random.below(4)) {
    case 0:
      return fmt::format("{:.{}f}", value, random.below(12));
    case 1:
      return fmt::format("{:e}", value);
    case 2:
      return fmt::format("{}", value);
    default:
      return fmt::format("{}", static_cast<int>(random.below(100000)));
  }
}

TEST(ParseRows, EveryNumberIsTheNearestDouble) {
  RandomStream random(1);
  std::string text;
  std::vector<double> wanted;
  for (int i = 0; i < 60000; ++i) {
    const std::string spelling = random_spelling(random);
    text += spelling + (i % 3 == 2 ? "\n" : " ");
    wanted.push_back(std::strtod(spelling.c_str(), nullptr));
  }
  TextRows rows;
  rows.columns = 3;
  const ParsedRows parsed = parse_rows(text, rows, "t");
  ASSERT_EQ(parsed.numbers.size(), wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i)
    ASSERT_EQ(std::bit_cast<std::uint64_t>(parsed.numbers[i]), std::bit_cast<std::uint64_t>(wanted[i])) << i;
}

TEST(ParseRows, TakesOddSpellingsAndRefusesWords) {
  TextRows rows;
  rows.columns = 3;
  EXPECT_EQ(parse_rows("-0 .5 5.\n", rows, "t").numbers, (std::vector<double>{-0.0, 0.5, 5.0}));
  EXPECT_EQ(parse_rows("123456789012345678 0.12345678901234567890 1e-400\n", rows, "t").numbers,
            (std::vector<double>{123456789012345678.0, 0.12345678901234567890, 0.0}));
  EXPECT_TRUE(std::isnan(parse_rows("nan -inf 1\n", rows, "t").numbers[0]));
  for (const char* bad : {"1 2 .\n", "1 2 -\n", "1 2 1.2.3\n", "1 2 3m\n", "1 2 --3\n", "1 2 0x10\n"})
    EXPECT_ANY_THROW(parse_rows(bad, rows, "t")) << bad;
}

}  // namespace
}  // namespace limen
