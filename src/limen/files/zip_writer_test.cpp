// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "limen/base/error.h"
#include "limen/files/zip.h"

namespace limen {
namespace {

TEST(ZipWriter, WhatWasPackedComesOutAgain) {
  std::string noise;
  for (unsigned k = 0; k < 100000; ++k) noise += static_cast<char>((k * 2654435761U) >> 24U);
  const std::vector<ZipFile> files = {{"a.txt", "some words"}, {"folder/empty", ""}, {"folder/noise", noise}};
  const std::string archive = zipped(files);
  const std::vector<ZipMember> members = zip_members(archive);
  ASSERT_EQ(members.size(), files.size());
  for (std::size_t k = 0; k < files.size(); ++k) {
    EXPECT_EQ(members[k].name, files[k].name);
    EXPECT_EQ(unpacked(archive, members[k], "archive", 1000000), files[k].bytes);
  }
  EXPECT_EQ(zipped(files), archive);
  std::string damaged = archive;
  damaged[members[2].at + 30 + members[2].name.size() + 50] ^= 1;
  EXPECT_THROW(static_cast<void>(unpacked(damaged, members[2], "archive", 1000000)), Error);
}

TEST(ZipWriter, NothingIsAnEmptyArchive) {
  const std::string archive = zipped({});
  EXPECT_EQ(archive.size(), 22U);
  EXPECT_TRUE(zip_members(archive).empty());
}

}  // namespace
}  // namespace limen
