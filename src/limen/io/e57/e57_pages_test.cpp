// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/e57/e57_pages.h"

#include "support/synthetic_e57.h"
#include <gtest/gtest.h>

#include "limen/base/error.h"
#include "limen/base/random.h"
#include "limen/io/e57/e57_crc.h"

namespace limen {
namespace {

using namespace testing_e57;

std::string random_bytes(std::size_t count, std::uint64_t seed) {
  RandomStream random(seed);
  std::string bytes(count, '\0');
  for (char& byte : bytes) byte = static_cast<char>(random.below(256));
  return bytes;
}

/// Pages of a file whose payload is random behind the head.
std::string some_file(std::size_t payload_bytes, std::size_t page_bytes) {
  std::string logical = "ASTM-E57";
  const std::size_t payload = page_bytes - 4;
  put(logical, std::uint32_t{1});
  put(logical, std::uint32_t{0});
  put(logical, std::uint64_t{(payload_bytes + payload - 1) / payload * page_bytes});
  put(logical, std::uint64_t{48});
  put(logical, std::uint64_t{1});
  put(logical, std::uint64_t{page_bytes});
  return paged(logical + random_bytes(payload_bytes - 48, 5), page_bytes);
}

TEST(E57Crc, KnownValue) {
  EXPECT_EQ(crc32c("123456789"), 0xE3069283U);
  EXPECT_EQ(crc32c(""), 0U);
  EXPECT_EQ(crc32c(std::string(32, '\0')), 0x8A9136AAU);
}

TEST(E57Crc, TableInstructionAndBitByBitAgree) {
  for (std::size_t size = 0; size < 70; ++size) {
    const std::string bytes = random_bytes(size, size + 1);
    EXPECT_EQ(crc32c(bytes), slow_crc32c(bytes));
    EXPECT_EQ(crc32c_by_table(bytes), slow_crc32c(bytes));
  }
}

TEST(E57Pages, CopiesAcrossPages) {
  for (const std::size_t page_bytes : {64UL, 128UL, 1024UL}) {
    const std::string file = some_file(5000, page_bytes);
    std::string logical;
    for (std::size_t at = 0; at < file.size(); at += page_bytes) logical += file.substr(at, page_bytes - 4);
    const E57Pages pages(file, "some.e57");
    EXPECT_EQ(pages.logical_size(), logical.size());
    for (std::size_t begin = 48; begin < 400; begin += 7) {
      std::string copy(333, '\0');
      pages.copy(begin, copy.size(), copy.data());
      EXPECT_EQ(copy, logical.substr(begin, copy.size()));
      EXPECT_EQ(pages.logical_of(pages.physical_of(begin), "it"), begin);
    }
    EXPECT_NO_THROW(pages.check(0, pages.page_count()));
  }
}

TEST(E57Pages, NamesTheDamagedPageAndItsByte) {
  std::string file = some_file(300000, 1024);
  file[207 * 1024 + 11] ^= 0x10;
  file[290 * 1024 + 11] ^= 0x10;
  const E57Pages pages(file, "some.e57");
  EXPECT_NO_THROW(pages.check(0, 207));
  EXPECT_NO_THROW(pages.check(208, 290));
  try {
    pages.check(0, pages.page_count());
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(error.problem().find("page 207 of"), std::string::npos) << error.what();
    EXPECT_NE(error.where().find("byte 211968"), std::string::npos) << error.what();
    EXPECT_FALSE(error.remedy().empty());
  }
}

TEST(E57Pages, OffsetsThatCannotBe) {
  const std::string file = some_file(3000, 1024);
  const E57Pages pages(file, "some.e57");
  EXPECT_THROW((void)pages.logical_of(1020, "it"), Error);
  EXPECT_THROW((void)pages.logical_of(file.size(), "it"), Error);
  EXPECT_THROW((void)pages.logical_of(~std::uint64_t{0}, "it"), Error);
  EXPECT_EQ(pages.logical_of(1024, "it"), 1020U);
}

TEST(E57Pages, HeadsThatCannotBe) {
  const std::string file = some_file(3000, 1024);
  const auto with = [&](std::size_t at, std::uint64_t value) {
    std::string changed = file;
    std::memcpy(&changed[at], &value, sizeof value);
    return changed;
  };
  EXPECT_THROW(E57Pages(with(16, file.size() + 1024), "x"), Error);
  EXPECT_THROW(E57Pages(with(16, file.size() - 1), "x"), Error);
  EXPECT_THROW(E57Pages(with(16, 0), "x"), Error);
  EXPECT_THROW(E57Pages(with(40, 0), "x"), Error);
  EXPECT_THROW(E57Pages(with(40, 4), "x"), Error);
  EXPECT_THROW(E57Pages(with(40, 1022), "x"), Error);
  EXPECT_THROW(E57Pages(with(40, ~std::uint64_t{3}), "x"), Error);
  EXPECT_THROW(E57Pages(with(8, 2), "x"), Error);
  EXPECT_THROW(E57Pages(file.substr(0, 47), "x"), Error);
  EXPECT_THROW(E57Pages(file.substr(0, file.size() - 1), "x"), Error);
  const std::string longer = file + "tail";
  EXPECT_EQ(E57Pages(longer, "x").surplus(), 4U);
}

}  // namespace
}  // namespace limen
